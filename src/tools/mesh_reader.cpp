// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// proximity_mesh_reader: reads a mesh file from standard input and writes the mesh to standard output. kUsage lists the
// arguments. The format of the output is in mesh_stream.h.
//
// The parser may crash or hang on a broken file, so it runs in this process and not in the node. The process first sets
// limits for its own memory, time and files.

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "adapters/mesh/mesh_stream.h"
#include "hgrid_proximity/refusal.h"
#include "tools/plain_obj.h"
#include "tools/stl_check.h"

namespace {

using hgrid::Code;
using hgrid::Refusal;
using hgrid::StreamHeader;

constexpr char kUsage[] =
    "usage: proximity_mesh_reader KIND MAX_TRIANGLES MAX_MEMORY CPU_SECONDS < FILE > MESH\n\n"
    "Reads a mesh file and writes its triangles in a binary format. The proximity node starts this program for each "
    "mesh\n"
    "file of a robot, because a broken file may crash the reader.\n\n"
    "  KIND           stl, dae or obj\n"
    "  MAX_TRIANGLES  largest number of triangles\n"
    "  MAX_MEMORY     largest memory of the process [bytes]\n"
    "  CPU_SECONDS    largest CPU time of the process [s]\n"
    "  -h, --help     print this text and end\n\n"
    "exit codes: 0 the output is a mesh or says why there is none; 2 wrong arguments; others: the reader crashed\n";

struct Mesh {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Sets both the soft and the hard limit of a resource.
void limit(int resource, rlim_t value) {
  const struct rlimit both { value, value };
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

void limitProcess(rlim_t memory, rlim_t cpu_seconds) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their shadow memory exceeds any useful limit
  limit(RLIMIT_AS, memory);
#endif
  static_cast<void>(memory);
  limit(RLIMIT_CPU, cpu_seconds);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
  for (int fd = 3; fd < 1024; ++fd) close(fd);  // the parser must not use open files of the parent
  limit(RLIMIT_NOFILE, 3);
}

/// Returns the content of standard input. @throws Refusal resource_missing if it cannot be read to its end
std::string readAll() {
  std::string data;
  std::vector<char> chunk(1 << 16);
  for (;;) {
    const ssize_t got = read(0, chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Refusal(Code::resource_missing, std::string("it cannot be read: ") + std::strerror(errno));
    if (got == 0) return data;
    data.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

void writeAll(const void* data, std::size_t bytes) {
  const auto* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = write(1, at, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) std::_Exit(1);  // the parent no longer reads the output
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

/// Adds the triangles of a node and of its children to `mesh`, transformed to the frame of the root.
void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, Mesh& mesh,
             std::size_t max_triangles) {
  const aiMatrix4x4 transform = parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const unsigned second = transform.Determinant() < 0 ? 2 : 1;  // mirroring would turn the mesh inside out
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // after triangulation, other faces are points or lines
      mesh.triangles.push_back(
          {first + face.mIndices[0], first + face.mIndices[second], first + face.mIndices[3 - second]});
    }
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D p = transform * part.mVertices[v];
      mesh.vertices.push_back({p.x, p.y, p.z});
    }
    if (mesh.triangles.size() > max_triangles) {
      throw Refusal(Code::limit, "it has too many triangles; at most " + std::to_string(max_triangles) +
                                     " are allowed; simplify it");
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    collect(scene, *node.mChildren[i], transform, mesh, max_triangles);
  }
}

Mesh parse(const std::string& file, const std::string& kind, std::size_t max_triangles) {
  if (kind == "stl") hgrid::checkStl(file);
  const std::string data = kind == "obj" ? hgrid::plainObj(file) : file;
  Assimp::Importer importer;
  // Apply the unit of a COLLADA file, but ignore its up axis. RViz does the same.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFileFromMemory(
      data.data(), data.size(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices, kind.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string error = importer.GetErrorString();
    if (error.find("bad_alloc") != std::string::npos)
      throw std::bad_alloc();  // assimp has turned the exception into text
    throw Refusal(Code::parse, "it cannot be read: " + error);
  }
  Mesh mesh;
  collect(*scene, *scene->mRootNode, aiMatrix4x4(), mesh, max_triangles);
  return mesh;
}

void writeRefusal(Code code, const std::string& sentence) {
  const std::string shown = sentence.substr(0, 1000);
  const StreamHeader header{StreamHeader::kRefusal, static_cast<std::uint32_t>(code),
                            static_cast<std::uint32_t>(shown.size())};
  writeAll(&header, sizeof(header));
  writeAll(shown.data(), shown.size());
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) return std::fputs(kUsage, stdout), 0;
  }
  if (argc != 5) return std::fputs("proximity_mesh_reader needs four arguments; --help lists them\n", stderr), 2;
  const auto number = [&](int i) { return std::strtoull(argv[i], nullptr, 10); };
  limitProcess(number(3), number(4));
  try {
    const Mesh mesh = parse(readAll(), argv[1], number(2));
    const StreamHeader header{StreamHeader::kMesh, static_cast<std::uint32_t>(mesh.vertices.size()),
                              static_cast<std::uint32_t>(mesh.triangles.size())};
    writeAll(&header, sizeof(header));
    writeAll(mesh.vertices.data(), mesh.vertices.size() * sizeof(mesh.vertices[0]));
    writeAll(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  } catch (const Refusal& refusal) {
    writeRefusal(refusal.code(), refusal.what());
  } catch (const std::bad_alloc&) {
    writeRefusal(Code::limit, "reading it needs more memory than is allowed");
  } catch (const std::exception& error) {
    writeRefusal(Code::parse, error.what());
  }
  return 0;
}
