// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/sources/source_id.h"

namespace hgrid {

/// Stores the sources that should be in the world but are not, each with a sentence that says why.
class MissingSources {
 public:
  /// At first, every configured map, cloud and tracker is missing.
  explicit MissingSources(const Params& params);

  void set(const SourceId& source, const std::string& sentence) { sentences_.insert_or_assign(source, sentence); }
  /// Returns whether a source of this kind is missing.
  bool hasKind(SourceKind kind) const {
    return std::any_of(sentences_.begin(), sentences_.end(),
                       [kind](const auto& one) { return one.first.kind == kind; });
  }
  bool has(const SourceId& source) const { return sentences_.count(source) != 0; }
  void erase(const SourceId& source) noexcept { sentences_.erase(source); }
  /// Erases the sources for which `chosen` returns true. `chosen` must not throw.
  template <class Chosen>
  void eraseIf(const Chosen& chosen) noexcept {
    for (auto one = sentences_.begin(); one != sentences_.end();) {
      one = chosen(one->first) ? sentences_.erase(one) : std::next(one);
    }
  }
  void swap(MissingSources& other) noexcept { sentences_.swap(other.sentences_); }

  /// Appends a SourceGap for each missing source, sorted by name.
  void appendGaps(std::vector<SourceGap>& gaps) const;

 private:
  std::map<SourceId, std::string> sentences_;
};

}  // namespace hgrid
