// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bodies/nearest_names.h"

#include <algorithm>
#include <utility>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostCompared = 20000, kMostNames = 3;

/// Returns how many bytes must be replaced, removed or added to turn one text into the other (Levenshtein 1966).
std::size_t editDistance(const std::string& a, const std::string& b, std::vector<std::size_t>& row) {
  row.resize(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t exchanged = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({exchanged, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string> nearestNames(const std::string& name, const NameList& names) {
  const std::size_t most = std::max<std::size_t>(1, name.size() / 3);
  if (name.empty() || name.size() > 64 || names.size() > kMostCompared) return {};
  std::vector<std::pair<std::size_t, const std::string*>> near;
  std::vector<std::size_t> row;
  for (const std::string* whole : names) {
    const std::string local = whole->substr(whole->find('/') + 1);
    for (const std::string* candidate : {whole, &local}) {
      const std::size_t lengths_apart =
          std::max(candidate->size(), name.size()) - std::min(candidate->size(), name.size());
      if (lengths_apart > most) continue;
      const std::size_t apart = editDistance(name, *candidate, row);
      if (apart > most) continue;
      near.emplace_back(apart, whole);
      break;
    }
  }
  const std::size_t count = std::min(kMostNames, near.size());
  std::partial_sort(
      near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
      [](const auto& a, const auto& b) { return a.first != b.first ? a.first < b.first : *a.second < *b.second; });
  std::vector<std::string> nearest;
  for (std::size_t i = 0; i < count; ++i) nearest.push_back(*near[i].second);
  return nearest;
}

std::string similarNames(const std::string& name, const NameList& names) {
  std::string listed;
  for (const std::string& near : nearestNames(name, names)) {
    listed += (listed.empty() ? "; similar names are '" : ", '") + near + "'";
  }
  return listed;
}

std::string similarNames(const std::string& name, const BodyList& bodies) {
  NameList names;
  names.reserve(bodies.size());
  for (const Body& body : bodies) names.push_back(&body.name);
  return similarNames(name, names);
}

std::string noSuchBody(const std::string& name, const BodyList& bodies) {
  return "there is no body '" + printable(name) + "'" + similarNames(name, bodies);
}

}  // namespace hgrid
