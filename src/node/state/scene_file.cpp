// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/state/scene_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <limits>
#include <locale>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "hgrid_proximity/pairs/pair_rule.h"
#include "hgrid_proximity/refusal.h"
#include "node/params/body_params.h"
#include "node/params/obstacle_params.h"
#include "node/params/yaml_value.h"
#include "node/state/state_files.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestScene = 256 << 20;  // [byte]
constexpr std::size_t kLongestSceneName = 64;     // [byte]
constexpr std::size_t kMostSceneFiles = 10000;    // largest number of files in the folder of the scenes
constexpr std::string_view kEnding = ".yaml";

/// Returns the full path of the folder of the scenes. @throws Refusal resource_denied if ~state_folder is not set
std::string pathOfScenes(const std::string& state_folder) {
  if (state_folder.empty()) {
    throw Refusal(Code::resource_denied,
                  "scenes are stored in ~state_folder, which is not set; start the node with a folder");
  }
  return std::filesystem::absolute(state_folder).string() + "/scenes";
}

/// @throws Refusal bad_id
void checkSceneName(const std::string& name) {
  constexpr const char* kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
  if (!name.empty() && name.size() <= kLongestSceneName && name[0] != '.' &&
      name.find_first_not_of(kAllowed) == std::string::npos) {
    return;
  }
  throw Refusal(Code::bad_id, "the name of the scene is '" + printable(name, kLongestSceneName) +
                                  "'; it must have 1 to " + std::to_string(kLongestSceneName) +
                                  " letters, digits, '_', '-' or '.', and must not begin with '.'");
}

/// Returns the names of the files *.yaml in a folder, without this ending, sorted. @throws Refusal resource_denied;
/// limit
std::vector<std::string> sceneNamesIn(const std::string& folder) {
  std::vector<std::string> found;
  std::size_t count = 0;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (++count > kMostSceneFiles) {
      throw Refusal(Code::limit, "the folder '" + printable(folder, 300) + "' has more than " +
                                     std::to_string(kMostSceneFiles) + " files; move some of them to another folder");
    }
    const std::string name = entry->path().filename().string();
    const std::size_t length = name.size() - std::min(name.size(), kEnding.size());
    if (name.substr(length) == kEnding) found.push_back(name.substr(0, length));
  }
  if (error) {
    throw Refusal(Code::resource_denied, "cannot read '" + printable(folder, 300) + "': " + error.message());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Returns the shortest text that gives exactly this number. The exponent has a sign and the mantissa a point, because
/// readers of YAML 1.1 take it for a text otherwise.
std::string exactly(double value) {
  std::string written;
  for (const int digits : {15, 16, 17}) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(digits);
    out << value;
    written = out.str();
    std::istringstream in(written);
    in.imbue(std::locale::classic());
    double read = 0.0;
    in >> read;
    if (read == value) break;
  }
  const std::size_t exponent = written.find('e');
  if (written.find('.') == std::string::npos)
    written.insert(exponent == std::string::npos ? written.size() : exponent, ".0");
  return written;
}

/// Writes the parts of a scene.
class SceneWriter {
 public:
  explicit SceneWriter(const Params& params) : params_(params) {}

  void write(const std::map<std::string, PlacedObstacle>& obstacles, const std::vector<PairRule>& rules) {
    out_ << YAML::BeginMap << YAML::Key << "obstacles" << YAML::Value;
    beginList(obstacles.empty());
    for (const auto& obstacle : obstacles) write(obstacle.second);
    out_ << YAML::EndSeq << YAML::Key << "allowed_pairs" << YAML::Value;
    beginList(rules.empty());
    for (const PairRule& rule : rules) write(rule);
    out_ << YAML::EndSeq << YAML::EndMap;
  }
  std::string text() const { return std::string(out_.c_str()) + "\n"; }

 private:
  void beginList(bool is_empty) {
    if (is_empty) out_ << YAML::Flow;  // a block list cannot be empty
    out_ << YAML::BeginSeq;
  }
  void key(const char* name) { out_ << YAML::Key << name << YAML::Value; }
  void entry(const char* name, const std::string& value) {
    key(name);
    out_ << YAML::DoubleQuoted << value;
  }
  void entry(const char* name, double value) {
    key(name);
    out_ << exactly(value);
  }
  void entry(const char* name, bool value) {
    key(name);
    out_ << (value ? "true" : "false");
  }
  template <class Values>
  void numbers(const Values& values) {
    out_ << YAML::Flow << YAML::BeginSeq;
    for (const double value : values) out_ << exactly(value);
    out_ << YAML::EndSeq;
  }
  static std::vector<double> listOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
  void pose(const Pose& pose) {
    if (pose.matrix() == Pose::Identity().matrix()) return;
    key("pose");
    out_ << YAML::Flow << YAML::BeginMap;
    key("xyz");
    numbers(listOf(pose.translation()));
    if (pose.linear() != Eigen::Matrix3d::Identity()) {
      const Eigen::Quaterniond q(pose.linear());
      key("quaternion");
      numbers(std::vector<double>{q.x(), q.y(), q.z(), q.w()});
    }
    out_ << YAML::EndMap;
  }
  void lengths(const Shape& shape) {
    const std::vector<double> dimensions = shape.dimensions();
    if (shape.kind() == ShapeKind::box) {
      key("size");
      numbers(dimensions);
    } else if (shape.kind() == ShapeKind::sphere) {
      entry("radius", dimensions[0]);
    } else if (shape.kind() != ShapeKind::plane) {
      entry("height", dimensions[0]);
      entry("radius", dimensions[1]);
    }
  }
  void write(const BodyShape& shape, double usual_padding) {
    out_ << YAML::Flow << YAML::BeginMap;
    key("type");
    out_ << name(shape.shape.kind());
    if (const auto& mesh = shape.shape.mesh()) {
      key("vertices");
      out_ << YAML::BeginSeq;
      for (const Eigen::Vector3d& vertex : mesh->vertices) numbers(listOf(vertex));
      out_ << YAML::EndSeq;
      if (shape.shape.kind() == ShapeKind::mesh) {
        key("triangles");
        out_ << YAML::BeginSeq;
        for (const auto& triangle : mesh->triangles) {
          out_ << YAML::BeginSeq << triangle[0] << triangle[1] << triangle[2] << YAML::EndSeq;
        }
        out_ << YAML::EndSeq;
      }
    } else {
      lengths(shape.shape);
    }
    pose(shape.body_from_shape);
    if (shape.padding != usual_padding) entry("padding", shape.padding);
    out_ << YAML::EndMap;
  }
  void write(const Attachment& attachment) {
    key("attached");
    out_ << YAML::BeginMap;
    entry("link", attachment.link);
    pose(*attachment.link_from_body);
    std::vector<std::string> touch = attachment.touch;
    const std::string robot = attachment.link.substr(0, attachment.link.find('/') + 1);
    for (const std::string& link : attachment.touch_links) {
      if (!isGlob(link)) touch.push_back(robot + link);  // as in follow()
    }
    if (!touch.empty()) {
      key("touch");
      out_ << YAML::Flow << YAML::BeginSeq;
      for (const std::string& glob : touch) out_ << YAML::DoubleQuoted << glob;
      out_ << YAML::EndSeq;
    }
    out_ << YAML::EndMap;
  }
  void write(const PlacedObstacle& obstacle) {
    const RequestedObstacle& what = *obstacle.what;
    Body usual;  // as it would be if only the parameters said something
    usual.name = what.body.name;
    usual.shapes = what.body.shapes;
    applyMaxSpeed(params_, usual);
    applyPatterns(params_, usual);
    out_ << YAML::BeginMap;
    entry("name", what.body.name.substr(what.body.name.find('/') + 1));
    if (!obstacle.attachment) {
      const std::string frame = obstacle.asked.at ? "" : obstacle.asked.frame;
      if (!frame.empty()) entry("frame", frame);
      pose(obstacle.frame_from_body);
    }
    key("shapes");
    out_ << YAML::BeginSeq;
    for (std::size_t i = 0; i < what.body.shapes.size(); ++i) write(what.body.shapes[i], usual.shapes[i].padding);
    out_ << YAML::EndSeq;
    if (what.moving) entry("moving", true);
    if (what.body.margin != usual.margin) entry("margin", what.body.margin);
    if (what.body.max_speed != usual.max_speed) entry("max_speed", what.body.max_speed);
    if (what.lifetime.count() != 0) entry("lifetime", seconds(what.lifetime));
    if (what.lost_at_end) entry("lost_at_end", true);
    if (!obstacle.owner.empty()) entry("owner", obstacle.owner);
    if (!what.body.group.empty()) entry("group", what.body.group);
    if (obstacle.attachment) write(*obstacle.attachment);
    out_ << YAML::EndMap;
  }
  void write(const PairRule& rule) {
    out_ << YAML::BeginMap;
    entry("first", rule.first);
    entry("second", rule.second);
    if (!rule.reason.empty()) entry("reason", rule.reason);
    if (!rule.allowed) entry("allowed", false);
    out_ << YAML::EndMap;
  }

  const Params& params_;
  YAML::Emitter out_;
};

}  // namespace

std::string sceneText(const std::map<std::string, PlacedObstacle>& obstacles, const std::vector<PairRule>& rules,
                      const Params& params) {
  std::vector<PairRule> kept;
  for (const PairRule& rule : rules) {
    if (rule.origin == Origin::service && rule.ends == PairRule::Clock::time_point::max()) kept.push_back(rule);
  }
  SceneWriter writer(params);
  writer.write(obstacles, kept);
  return writer.text();
}

SavedScene readScene(const std::string& text, const std::string& what, const Params& params) {
  std::vector<std::string> errors;
  ParamValue root(valueOfYaml(text, what), what, errors);
  SavedScene scene;
  if (root.requireStruct()) {
    if (auto obstacles = root.require("obstacles")) scene.obstacles = readObstacles(*obstacles, params);
    if (auto rules = root.get("allowed_pairs")) scene.rules = readRules(*rules);
    root.finish("list of a scene (obstacles, allowed_pairs)");
  }
  for (const PairRule& rule : scene.rules) {
    try {
      checkRule(rule);
    } catch (const Refusal& refusal) {
      errors.push_back(what + "/allowed_pairs: " + refusal.what());
    }
  }
  if (errors.empty()) return scene;
  std::string sentence = errors.front();
  constexpr std::size_t kMostListed = 8;
  for (std::size_t i = 1; i < std::min(errors.size(), kMostListed); ++i) sentence += "; " + errors[i];
  if (errors.size() > kMostListed) sentence += "; and " + std::to_string(errors.size() - kMostListed) + " more";
  throw Refusal(Code::parse, sentence);
}

SceneList listScenes(const std::string& state_folder) {
  const std::string path = pathOfScenes(state_folder);
  const Descriptor folder = openOwnFolder(path);
  SceneList list;
  for (const std::string& scene : sceneNamesIn(path)) {
    const std::string file = scene + std::string(kEnding), full = path + "/" + file;
    try {
      checkSceneName(scene);
      const std::optional<OpenFile> opened = openFile(folder.get(), file, full, kLongestScene);
      if (!opened) continue;  // it was removed since
      if (opened->size == 0) throw Refusal(Code::parse, "the file '" + printable(full, 300) + "' is empty");
      list.scenes.push_back({scene, opened->last_write});
    } catch (const Refusal& refusal) {
      list.unusable.emplace_back(refusal.what());
    }
  }
  return list;
}

SceneFolder::SceneFolder(const std::string& state_folder, const std::string& name)
    : folder_(pathOfScenes(state_folder)), file_(name + std::string(kEnding)), path_(folder_ + "/" + file_) {
  checkSceneName(name);
}

void SceneFolder::write(const std::string& text, bool replace) const {
  if (text.size() > kLongestScene) {
    throw Refusal(Code::limit, "the scene would have " + std::to_string(text.size()) + " bytes; at most " +
                                   std::to_string(kLongestScene) + " are allowed");
  }
  const Descriptor folder = openOwnFolder(folder_);
  const std::string next = file_ + ".new";
  ::unlinkat(folder.get(), next.c_str(), 0);
  const Descriptor file(
      ::openat(folder.get(), next.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (file.get() < 0) failFile("create", path_ + ".new");
  writeAll(file.get(), text, path_ + ".new");
  if (::fsync(file.get()) != 0) failFile("write", path_ + ".new");
  if (replace) {
    if (::renameat(folder.get(), next.c_str(), folder.get(), file_.c_str()) != 0) failFile("replace", path_);
  } else {
    const bool is_new = ::linkat(folder.get(), next.c_str(), folder.get(), file_.c_str(), 0) == 0;
    const int why = errno;
    ::unlinkat(folder.get(), next.c_str(), 0);
    if (!is_new && why == EEXIST) {
      throw Refusal(Code::dup_id, "the file '" + printable(path_, 300) +
                                      "' exists already; set replace = true, or choose another name");
    }
    errno = why;
    if (!is_new) failFile("create", path_);
  }
  if (::fsync(folder.get()) != 0) failFile("write", folder_);
}

std::string SceneFolder::read() const {
  const Descriptor folder = openOwnFolder(folder_);
  const std::optional<std::string> text = bytesOf(folder.get(), file_, path_, kLongestScene);
  if (!text) {
    throw Refusal(Code::resource_missing,
                  "there is no scene '" + printable(path_, 300) + "'; save it with ~save_scene, or put a file there");
  }
  return *text;
}

}  // namespace hgrid
