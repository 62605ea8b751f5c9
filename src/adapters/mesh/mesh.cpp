// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/mesh.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "adapters/mesh/mesh_stream.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kLookAgain = 50;  // [ms] longest time between two checks for cancellation

std::string extensionOf(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  std::string extension = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Runs the helper process. The mesh file is its standard input. The parent reads its output until a deadline, and the
/// destructor always ends the process.
class Reader {
 public:
  Reader(const MeshPolicy& policy, const std::string& extension, int file, const std::string& what)
      : what_(what), policy_(policy), deadline_(Clock::now() + policy.timeout) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw Refusal(Code::limit, what_ + ": cannot create a pipe to the mesh reader: " + std::strerror(errno));
    output_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, file, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    const std::string limits[] = {std::to_string(policy.max_triangles), std::to_string(policy.max_memory),
                                  std::to_string(policy.timeout.count() / 1000 + 1)};
    const char* path = std::getenv("LD_LIBRARY_PATH");
    std::string library_path = std::string("LD_LIBRARY_PATH=") + (path == nullptr ? "" : path), locale = "LC_ALL=C";
    char* const arguments[] = {const_cast<char*>(policy.reader.c_str()), const_cast<char*>(extension.c_str()),
                               const_cast<char*>(limits[0].c_str()),     const_cast<char*>(limits[1].c_str()),
                               const_cast<char*>(limits[2].c_str()),     nullptr};
    char* const environment[] = {&library_path[0], &locale[0], nullptr};
    const int failure = posix_spawn(&process_, policy.reader.c_str(), &actions, nullptr, arguments, environment);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (failure != 0) {
      close(output_);
      throw Refusal(Code::resource_missing,
                    what_ + ": cannot start the mesh reader '" + policy.reader + "': " + std::strerror(failure));
    }
  }

  ~Reader() {
    close(output_);
    kill(process_, SIGKILL);  // the output of the process was read completely, or is not needed any more
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  /// Fills the buffer with output of the helper.
  /// @throws Refusal budget after the deadline
  /// @throws Refusal busy if reading was canceled
  /// @throws Refusal truncated if the helper ends too early
  void read(void* buffer, std::size_t bytes) {
    auto* at = static_cast<char*>(buffer);
    while (bytes > 0) {
      if (policy_.cancelled && policy_.cancelled()) throw Refusal(Code::busy, what_ + ": reading it was canceled");
      const std::int64_t left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
      if (left <= 0) {
        throw Refusal(Code::budget, what_ + ": reading it took longer than " +
                                        text(std::chrono::duration<double>(policy_.timeout).count()) +
                                        " s and was stopped");
      }
      pollfd poll_output{output_, POLLIN, 0};
      const int ready = poll(&poll_output, 1, static_cast<int>(std::min(left, kLookAgain)));
      if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
      const ssize_t got = ::read(output_, at, bytes);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        throw Refusal(Code::truncated, what_ +
                                           ": the mesh reader ended before the mesh was complete; the file may be "
                                           "broken, or may need more memory or time than is allowed");
      }
      at += got;
      bytes -= static_cast<std::size_t>(got);
    }
  }

 private:
  std::string what_;
  const MeshPolicy& policy_;
  Clock::time_point deadline_;
  pid_t process_ = -1;
  int output_ = -1;
};

std::shared_ptr<const TriangleMesh> readMesh(const OpenResource& file, const MeshPolicy& policy,
                                             const std::string& what) {
  const std::string extension = extensionOf(file.path());
  if (extension != "stl" && extension != "dae" && extension != "obj") {
    throw Refusal(Code::unsupported, what + " is of kind '" + printable(extension) + "'; it must be STL, DAE or OBJ");
  }
  Reader reader(policy, extension, file.fd(), what);
  StreamHeader header;
  reader.read(&header, sizeof(header));
  if (header.kind == StreamHeader::kRefusal && header.triangles <= 1000 &&
      header.vertices <= static_cast<std::uint32_t>(Code::internal)) {
    std::string sentence(header.triangles, '\0');
    reader.read(&sentence[0], sentence.size());
    throw Refusal(static_cast<Code>(header.vertices), what + ": " + printable(sentence, 200));
  }
  if (header.kind != StreamHeader::kMesh) {
    throw Refusal(Code::internal, what + ": the mesh reader returned something other than a mesh");
  }
  if (header.triangles > policy.max_triangles || header.vertices > 3 * policy.max_triangles) {
    throw Refusal(Code::limit, what + " has " + std::to_string(header.triangles) + " triangles and " +
                                   std::to_string(header.vertices) + " vertices; at most " +
                                   std::to_string(policy.max_triangles) + " triangles are allowed");
  }
  auto mesh = std::make_shared<TriangleMesh>();
  std::vector<Eigen::Vector3f> vertices(header.vertices);
  reader.read(vertices.data(), vertices.size() * sizeof(Eigen::Vector3f));
  mesh->triangles.resize(header.triangles);
  reader.read(mesh->triangles.data(), mesh->triangles.size() * sizeof(mesh->triangles[0]));
  mesh->vertices.reserve(vertices.size());
  for (const Eigen::Vector3f& vertex : vertices) mesh->vertices.push_back(vertex.cast<double>());
  return mesh;
}

std::shared_ptr<const TriangleMesh> scaled(const TriangleMesh& mesh, const Eigen::Vector3d& scale) {
  auto result = std::make_shared<TriangleMesh>(mesh);
  for (Eigen::Vector3d& vertex : result->vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() < 0.0) {  // mirroring would turn the mesh inside out
    for (auto& triangle : result->triangles) std::swap(triangle[1], triangle[2]);
  }
  return result;
}

/// Adds its lifetime to a sum.
struct AddedTime {
  explicit AddedTime(Clock::duration& total) : sum(total) {}
  AddedTime(const AddedTime&) = delete;
  AddedTime& operator=(const AddedTime&) = delete;
  ~AddedTime() { sum += Clock::now() - begin; }
  Clock::duration& sum;
  const Clock::time_point begin = Clock::now();
};

void checkScale(const Eigen::Vector3d& scale, const std::string& what) {
  for (int axis = 0; axis < 3; ++axis) {
    const double factor = std::abs(scale[axis]);
    if (!(factor >= 1e-9 && factor <= 1e9)) {
      throw Refusal(Code::bad_geometry, what + " has scale." + "xyz"[axis] + " = " + text(scale[axis]) +
                                            "; its absolute value must be within 1e-09 .. 1e+09");
    }
  }
}

}  // namespace

/// Reads a file within the time that is left for all files.
std::shared_ptr<const TriangleMesh> MeshLoader::read(const OpenResource& file, const std::string& what) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(policy_.total - spent_);
  if (left.count() <= 0) {
    throw Refusal(Code::budget, what + ": it was not read, because reading the files before it took " +
                                    text(std::chrono::duration<double>(policy_.total).count()) +
                                    " s, which is the limit for all mesh files of a robot; allow more time");
  }
  MeshPolicy policy = policy_;
  policy.timeout = std::min(policy.timeout, left);
  const AddedTime added(spent_);
  return readMesh(file, policy, what);
}

std::shared_ptr<const TriangleMesh> MeshLoader::load(const std::string& uri, const Eigen::Vector3d& scale) {
  const std::string what = "mesh '" + printable(uri) + "'";
  checkScale(scale, what);
  const OpenResource file = openResource(uri, policy_.resources);
  std::shared_ptr<const TriangleMesh>& raw = read_[file.path()];
  if (!raw) raw = read(file, what);
  const auto mesh = scale == Eigen::Vector3d::Ones() ? raw : scaled(*raw, scale);
  // A file in millimeters may hold large numbers, so only what they are in meters counts.
  const std::string factors = text(scale.x()) + " " + text(scale.y()) + " " + text(scale.z());
  checkMesh(*mesh, ShapeLimits{}.max_size, what + " at scale " + factors);
  return mesh;
}

}  // namespace hgrid
