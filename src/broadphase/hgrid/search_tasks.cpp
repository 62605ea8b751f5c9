// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/search_tasks.h"

#include <algorithm>
#include <utility>

#include "broadphase/hgrid/found_boxes.h"

namespace hgrid {
namespace {

/// Adds tasks that test all boxes of the level `asking` against the level `asked`. If `asked` is null, they are tested
/// against each other.
void addTask(std::vector<SearchTask>& tasks, const kernels::Level& asking, const kernels::Level* asked) {
  for (std::uint32_t begin = asking.begin; begin < asking.end; begin += SearchTask::kBoxes) {
    tasks.push_back({&asking, asked, begin, std::min(begin + SearchTask::kBoxes, asking.end)});
    tasks.back().boxes = tasks.back().end - begin;
  }
}

/// Adds tasks that test the boxes of two levels against each other.
void addAcross(std::vector<SearchTask>& tasks, const kernels::Level& first, const kernels::Level& second) {
  if (first.begin == first.end || second.begin == second.end) return;
  if (firstAsks(first, first.end - first.begin, second, second.end - second.begin)) {
    addTask(tasks, first, &second);
  } else {
    addTask(tasks, second, &first);
  }
}

/// Adds tasks for the regions of a layer. Each task gets as many regions as are needed for SearchTask::kBoxes boxes.
void addRegions(std::vector<SearchTask>& tasks, const Layer& layer, const Layer* other) {
  const std::size_t regions = layer.regions().size();
  SearchTask task{};
  task.layer = &layer;
  task.other = other;
  for (std::size_t number = 0; number < regions; ++number) {
    const kernels::Region& region = layer.regions().region(number);
    for (std::uint32_t i = 0; i < region.levels; ++i) {
      const kernels::Level& level = layer.levels()[region.first_level + i];
      task.boxes += level.end - level.begin;
    }
    task.end = static_cast<std::uint32_t>(number + 1);
    if (task.boxes < SearchTask::kBoxes && number + 1 < regions) continue;
    tasks.push_back(task);
    task.begin = task.end;
    task.boxes = 0;
  }
}

/// Adds tasks that test the boxes of all regions of a layer against one level of another layer. A task may
/// contain boxes of several levels, if these levels follow each other and all overlap `asked`.
void addRegionsAcross(std::vector<SearchTask>& tasks, const Layer& layer, const kernels::Level& asked) {
  const std::vector<kernels::Level>& levels = layer.levels();
  const kernels::Level* first = nullptr;
  std::uint32_t begin = 0;
  const auto ask = [&](std::uint32_t end) {
    for (; first != nullptr && begin < end; begin += SearchTask::kBoxes) {
      tasks.push_back({first, &asked, begin, std::min(begin + SearchTask::kBoxes, end)});
      tasks.back().boxes = tasks.back().end - begin;
    }
    first = nullptr;
  };
  for (const kernels::Level& level : levels) {
    if (!overlap(level.around, asked.around)) {
      ask(level.begin);
    } else if (first == nullptr) {
      first = &level;
      begin = level.begin;
    }
  }
  ask(levels.back().end);
}

}  // namespace

bool firstAsks(const kernels::Level& first, std::size_t boxes, const kernels::Level& second, std::size_t others) {
  return static_cast<double>(boxes) * rowsAsked(first, second) <=
         static_cast<double>(others) * rowsAsked(second, first);
}

/// Adds tasks that test each level of a layer against itself and against each later level (Ericson 2005, 7.2).
void addWithin(std::vector<SearchTask>& tasks, const Layer& layer) {
  if (layer.isDivided()) return addRegions(tasks, layer, nullptr);
  const std::vector<kernels::Level>& levels = layer.levels();
  for (std::size_t level = 0; level < levels.size(); ++level) {
    addTask(tasks, levels[level], nullptr);
    for (std::size_t later = level + 1; later < levels.size(); ++later) {
      addAcross(tasks, levels[level], levels[later]);
    }
  }
}

/// Adds tasks that test the boxes of two layers against each other.
void addAcross(std::vector<SearchTask>& tasks, const Layer& a, const Layer& b) {
  if (a.levels().empty() || b.levels().empty()) return;
  const std::pair<const Layer*, const Layer*> orders[] = {{&a, &b}, {&b, &a}};
  for (const auto& [some, others] : orders) {
    if (some->isDivided() && !others->isDivided() && some->size() <= others->size()) {
      for (const kernels::Level& level : others->levels()) addRegionsAcross(tasks, *some, level);
      return;
    }
  }
  if (a.isDivided() || b.isDivided()) {
    return a.regions().size() >= b.regions().size() ? addRegions(tasks, a, &b) : addRegions(tasks, b, &a);
  }
  for (const kernels::Level& first : a.levels()) {
    for (const kernels::Level& second : b.levels()) addAcross(tasks, first, second);
  }
}

}  // namespace hgrid
