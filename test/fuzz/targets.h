// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <string_view>

namespace hgrid {
namespace test {

/// The result of reading one input of a fuzzer.
struct FuzzResult {
  bool accepted = false;
  std::string flaw;  ///< what is wrong with the result or with the refusal; empty if nothing is wrong
};

// Each fuzz target is a function that reads one input. test/fuzz/run runs it as a libFuzzer program, and a test runs it
// for all seeds in test/fuzz/<target>.

/// Reads an OctoMap file or the data of a message. The bits of the first byte select the options.
FuzzResult fuzzOctomap(std::string_view input);
/// Reads the text of a URDF.
FuzzResult fuzzUrdf(std::string_view input);
/// Reads the text of an SRDF.
FuzzResult fuzzSrdf(std::string_view input);
/// Reads a mesh file in the helper process. The first byte is the kind of the file: s, o or d for STL, OBJ or DAE.
FuzzResult fuzzMesh(std::string_view input);
/// Reads an OBJ file without the helper process.
FuzzResult fuzzObj(std::string_view input);
/// Reads a PointCloud2 message. The first byte selects whether the other bytes are the message, or only describe its
/// layout.
FuzzResult fuzzCloud(std::string_view input);
/// Reads a request or a message. The first byte selects the type. It also selects whether the other bytes are the
/// message, or the values of the fields of a valid message.
FuzzResult fuzzWire(std::string_view input);
/// Reads the parameters of the node. The bytes describe the tree of parameters.
FuzzResult fuzzParams(std::string_view input);

}  // namespace test
}  // namespace hgrid
