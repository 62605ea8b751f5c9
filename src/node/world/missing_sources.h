// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/sources/source_id.h"

namespace hgrid {

/// The sources that should be in the world but are not, each with a sentence that says why.
class MissingSources {
 public:
  /// Every configured robot, map and cloud is missing at first.
  explicit MissingSources(const Params& params);

  void set(const SourceId& source, const std::string& sentence) { sentences_.insert_or_assign(source, sentence); }
  bool has(const SourceId& source) const { return sentences_.count(source) != 0; }
  void erase(const SourceId& source) noexcept { sentences_.erase(source); }
  /// Erases the sources for which `chosen` is true. It must not throw.
  template <class Chosen>
  void eraseIf(const Chosen& chosen) noexcept {
    for (auto one = sentences_.begin(); one != sentences_.end();) {
      one = chosen(one->first) ? sentences_.erase(one) : std::next(one);
    }
  }
  void swap(MissingSources& other) noexcept { sentences_.swap(other.sentences_); }

  /// Appends a gap for each missing source, in the order of their names.
  void appendGaps(std::vector<SourceGap>& gaps) const;

 private:
  std::map<SourceId, std::string> sentences_;
};

}  // namespace hgrid
