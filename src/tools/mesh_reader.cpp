// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// proximity_mesh_reader: reads a mesh file from standard input and writes the mesh to standard output. kUsage lists the
// arguments. The format of the output is in mesh_stream.h.
//
// A broken file may take much time or memory, or show an error of a parser. So files are read in this process and not
// in the node. The process first sets limits for its own memory, time and files.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "adapters/mesh/mesh_stream.h"
#include "hgrid_proximity/refusal.h"
#include "tools/mesh/dae_file.h"
#include "tools/mesh/obj_file.h"
#include "tools/mesh/stl_file.h"

namespace {

using hgrid::Code;
using hgrid::Refusal;
using hgrid::StreamHeader;
using hgrid::Triangles;

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

/// @throws Refusal if it cannot be read, or if a part of its surface would be missing
Triangles parse(const std::string& file, const std::string& kind, std::size_t max_triangles) {
  Triangles mesh(max_triangles);
  if (kind == "dae") {
    hgrid::readDae(file, mesh);
  } else {
    mesh.add(kind == "stl" ? hgrid::readStl(file) : hgrid::readObj(file));
  }
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
    const Triangles mesh = parse(readAll(), argv[1], number(2));
    const StreamHeader header{StreamHeader::kMesh, static_cast<std::uint32_t>(mesh.vertices().size()),
                              static_cast<std::uint32_t>(mesh.triangles().size())};
    writeAll(&header, sizeof(header));
    writeAll(mesh.vertices().data(), mesh.vertices().size() * sizeof(mesh.vertices()[0]));
    writeAll(mesh.triangles().data(), mesh.triangles().size() * sizeof(mesh.triangles()[0]));
  } catch (const Refusal& refusal) {
    writeRefusal(refusal.code(), refusal.what());
  } catch (const std::bad_alloc&) {
    writeRefusal(Code::limit, "reading it needs more memory than is allowed");
  } catch (const std::exception& error) {
    writeRefusal(Code::parse, error.what());
  }
  return 0;
}
