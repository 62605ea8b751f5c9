// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <time.h>

#include <map>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/world/placed_obstacle.h"

namespace hgrid {

/// What a scene file contains: lists as in ~obstacles and ~allowed_pairs.
struct SavedScene {
  std::vector<ObstacleParams> obstacles;
  std::vector<PairRule> rules;
};

/// Returns the obstacles and rules as YAML, in the form of the parameters obstacles and allowed_pairs.
/// @param rules   those of ~set_allowed are written if they never end; the others are left out
/// @param params  what the parameters say about margin, speed and padding of an obstacle is left out
std::string sceneText(const std::map<std::string, PlacedObstacle>& obstacles, const std::vector<PairRule>& rules,
                      const Params& params);

/// Reads the text of a scene file.
/// @param what  name of the file for error sentences
/// @throws Refusal parse; the sentence lists everything that is wrong
SavedScene readScene(const std::string& text, const std::string& what, const Params& params);

/// The scenes in ~state_folder.
struct SceneList {
  struct Entry {
    std::string name;     ///< as in ~load_scene
    timespec last_write;  ///< since the beginning of 1970, UTC
  };
  std::vector<Entry> scenes;          ///< sorted by name
  std::vector<std::string> unusable;  ///< for each other file *.yaml: why ~load_scene cannot load it, as a sentence
};
/// Lists the scenes. Opens each file, but does not read it.
/// @throws Refusal resource_denied if ~state_folder is not set or cannot be read; limit if it has more than 10000 files
SceneList listScenes(const std::string& state_folder);

/// The file of one scene: "scenes/NAME.yaml" in ~state_folder.
class SceneFolder {
 public:
  /// @param state_folder  ~state_folder
  /// @throws Refusal resource_denied if it is not set; bad_id if the name is not a plain name
  SceneFolder(const std::string& state_folder, const std::string& name);

  /// Returns the full path of the file.
  const std::string& path() const { return path_; }
  /// Writes the file. When this returns, it is on disk.
  /// @throws Refusal dup_id if the file exists and `replace` is false; limit if it is too long; resource_denied
  void write(const std::string& text, bool replace) const;
  /// Reads the file. @throws Refusal resource_missing if it does not exist; limit if it is too long; resource_denied
  std::string read() const;

 private:
  std::string folder_, file_, path_;
};

}  // namespace hgrid
