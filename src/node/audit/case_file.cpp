// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/case_file.h"

#include <cstdlib>
#include <iomanip>
#include <istream>
#include <ostream>
#include <sstream>
#include <type_traits>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr const char* kTitle = "hgrid_proximity_audit_1";  // kind and version of the file

/// Writes the values of a case as text. A line is a word and values, with spaces between them. CaseReader reads this
/// text. The functions below list the values of a case once, for both classes. Thus writing and reading cannot differ.
class CaseWriter {
 public:
  static constexpr bool kReads = false;
  explicit CaseWriter(std::ostream& out) : out_(out) { out_ << std::setprecision(17); }

  void line(const char* word) { out_ << (std::exchange(first_, false) ? "" : "\n") << word; }
  void value(const double& number) { out_ << ' ' << number; }
  void value(const std::string& text) {
    out_ << " %";
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte > ' ' && byte < 0x7f && c != '%') {
        out_ << c;
      } else {
        out_ << '%' << "0123456789abcdef"[byte >> 4] << "0123456789abcdef"[byte & 15];
      }
    }
  }
  template <class Number, std::enable_if_t<std::is_integral<Number>::value || std::is_enum<Number>::value, int> = 0>
  void value(const Number& number) {
    out_ << ' ' << static_cast<std::int64_t>(number);
  }

 private:
  std::ostream& out_;
  bool first_ = true;
};

/// Reads values that CaseWriter wrote.
class CaseReader {
 public:
  static constexpr bool kReads = true;
  explicit CaseReader(std::istream& in) : in_(in) {}

  void line(const char* word) {
    ++line_;
    std::string text;
    if (!std::getline(in_, text)) fail("the file ends; there should be '" + std::string(word) + "'");
    values_.clear();
    values_.str(text);
    if (next() != word) fail("it should begin with '" + std::string(word) + "'");
  }
  void value(double& number) {
    const std::string text = next();
    char* end = nullptr;
    number = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') fail("'" + printable(text) + "' should be a number");
  }
  void value(std::string& result) {
    const std::string text = next();
    if (text.empty() || text[0] != '%') fail("'" + printable(text) + "' should be a text, which begins with %");
    result.clear();
    for (std::size_t i = 1; i < text.size(); ++i) {
      if (text[i] == '%' && i + 2 < text.size()) {
        result += static_cast<char>(std::strtol(text.substr(i + 1, 2).c_str(), nullptr, 16));
        i += 2;
      } else {
        result += text[i];
      }
    }
  }
  template <class Number, std::enable_if_t<std::is_integral<Number>::value || std::is_enum<Number>::value, int> = 0>
  void value(Number& number) {
    const std::string text = next();
    char* end = nullptr;
    number = static_cast<Number>(std::strtoll(text.c_str(), &end, 10));
    if (text.empty() || *end != '\0') fail("'" + printable(text) + "' should be a whole number");
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw Refusal(Code::parse, "line " + std::to_string(line_) + " of the audit file is not valid: " + why);
  }

 private:
  std::string next() {
    std::string word;
    values_ >> word;
    return word;
  }
  std::istream& in_;
  std::istringstream values_;
  std::size_t line_ = 0;
};

// Each pass() function takes a file and a value. If the file is a CaseWriter, the function writes the value. If the
// file is a CaseReader, the function reads the value and stores it.

template <class File>
void pass(File& file, Time& time) {
  auto count = static_cast<std::int64_t>(time.count());
  file.value(count);
  time = Time(count);
}

template <class File>
void pass(File& file, Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) file.value(vector[axis]);
}

template <class File>
void pass(File& file, Pose& pose) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) file.value(pose.matrix()(row, column));
  }
}

/// Writes or reads a list: first a line with `word` and the number of elements, then the elements.
/// @param blank  the value of an element before it is read
/// @param each   writes or reads one element
template <class File, class Element, class Each>
void passAll(File& file, const char* word, std::vector<Element>& elements, const Element& blank, const Each& each) {
  std::size_t count = elements.size();
  file.line(word);
  file.value(count);
  if (File::kReads) elements.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (File::kReads) elements.push_back(blank);  // no reserve(): a wrong count must not allocate much
    each(elements[i]);
  }
}

template <class File>
void pass(File& file, TriangleMesh& mesh) {
  passAll(file, "vertices", mesh.vertices, Eigen::Vector3d(Eigen::Vector3d::Zero()), [&](Eigen::Vector3d& vertex) {
    file.line("vertex");
    pass(file, vertex);
  });
  passAll(file, "triangles", mesh.triangles, {}, [&](std::array<std::uint32_t, 3>& triangle) {
    file.line("triangle");
    for (std::uint32_t& corner : triangle) file.value(corner);
  });
}

Shape shapeOf(ShapeKind kind, const std::vector<double>& dimensions, const TriangleMesh& mesh) {
  const ShapeLimits limits{0.0, 1e9, true};
  const auto shared = std::make_shared<const TriangleMesh>(mesh);
  if (kind == ShapeKind::hull) return Shape::hull(shared, limits);
  if (kind == ShapeKind::mesh) return Shape::mesh(shared, limits);
  return Shape::primitive(static_cast<int>(kind), dimensions, limits);
}

template <class File>
void pass(File& file, BodyShape& shape) {
  ShapeKind kind = shape.shape.kind();
  std::vector<double> dimensions = shape.shape.dimensions();
  TriangleMesh mesh = shape.shape.mesh() ? *shape.shape.mesh() : TriangleMesh{};
  file.line("shape");
  file.value(kind);
  file.value(shape.padding);
  pass(file, shape.body_from_shape);
  passAll(file, "dimensions", dimensions, 0.0, [&](double& length) {
    file.line("dimension");
    file.value(length);
  });
  if (kind == ShapeKind::hull || kind == ShapeKind::mesh) pass(file, mesh);
  if (File::kReads) shape.shape = shapeOf(kind, dimensions, mesh);
}

template <class File>
void pass(File& file, Body& body) {
  file.line("body");
  file.value(body.name);
  file.value(body.frame);
  file.value(body.robot);
  file.value(body.kind);
  file.value(body.mobility);
  file.value(body.margin);
  file.value(body.max_speed);
  pass(file, body.frame_from_body);
  const BodyShape blank{Shape::sphere(1.0), Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones()};
  passAll(file, "shapes", body.shapes, blank, [&](BodyShape& shape) { pass(file, shape); });
}

template <class File>
void pass(File& file, BodyPose& pose) {
  file.line("pose");
  file.value(pose.state);
  pass(file, pose.stamp);
  file.value(pose.age);
  pass(file, pose.world_from_body);
}

template <class File>
void pass(File& file, RecordedTransform& transform) {
  file.line("transform");
  file.value(transform.parent);
  file.value(transform.child);
  file.value(transform.publisher);
  file.value(transform.is_static);
  pass(file, transform.stamp);
  pass(file, transform.received);
  for (double& number : transform.numbers) file.value(number);
}

template <class File>
void pass(File& file, RecordedCells& cells) {
  file.line("map");
  file.value(cells.body);
  file.value(cells.finest_edge);
  passAll(file, "cells", cells.voxels, {}, [&](Voxel& voxel) {
    file.line("cell");
    file.value(voxel.x);
    file.value(voxel.y);
    file.value(voxel.z);
    file.value(voxel.level);
  });
}

template <class File>
void pass(File& file, NearPair& pair) {
  file.line("pair");
  file.value(pair.first);
  file.value(pair.second);
  file.value(pair.gap);
  file.value(pair.margin);
  file.value(pair.flags);
}

template <class File>
void pass(File& file, RecordedQuery& query) {
  file.line("query");
  file.value(query.kind);
  file.value(query.verdict);
  pass(file, query.from);
  pass(file, query.to);
  file.value(query.radius);
  pass(file, query.box.size);
  pass(file, query.box.world_from_box);
  passAll(file, "hits", query.hits, {}, [&](RecordedQuery::Hit& hit) {
    file.line("hit");
    file.value(hit.body);
    file.value(hit.distance);
  });
}

template <class File>
void passSettings(File& file, AuditCase& audited) {
  file.line("settings");
  for (double* number : {&audited.margin, &audited.growth_cap, &audited.growth_after, &audited.max_sync_wait,
                         &audited.max_future, &audited.world_limit, &audited.origin_distance}) {
    file.value(*number);
  }
  PairKinds& kinds = audited.pair_kinds;
  file.line("pair_kinds");
  for (bool* kind :
       {&kinds.self, &kinds.robot_robot, &kinds.robot_obstacle, &kinds.robot_map, &kinds.moving_obstacle}) {
    file.value(*kind);
  }
  passAll(file, "pair_margins", audited.pair_margins, {}, [&](PairMargin& entry) {
    file.line("pair_margin");
    file.value(entry.first);
    file.value(entry.second);
    file.value(entry.margin);
  });
  passAll(file, "rules", audited.rules, {}, [&](PairRule& rule) {
    file.line("rule");
    file.value(rule.first);
    file.value(rule.second);
    file.value(rule.allowed);
  });
}

template <class File>
void passCase(File& file, AuditCase& audited) {
  file.line(kTitle);
  file.line("tick");
  file.value(audited.config_hash);
  file.value(audited.epoch);
  file.value(audited.sequence);
  pass(file, audited.stamp);
  pass(file, audited.made);
  pass(file, audited.record_begin);
  file.value(audited.world_frame);
  file.value(audited.truncated);
  file.value(audited.all_static);
  passSettings(file, audited);
  passAll(file, "names", audited.names, {}, [&](std::string& name) {
    file.line("name");
    file.value(name);
  });
  passAll(file, "transforms", audited.transforms, {}, [&](RecordedTransform& transform) { pass(file, transform); });
  passAll(file, "bodies", audited.bodies, {}, [&](Body& body) { pass(file, body); });
  passAll(file, "poses", audited.poses, {}, [&](BodyPose& pose) { pass(file, pose); });
  passAll(file, "switched_off", audited.switched_off, {}, [&](std::pair<std::uint32_t, std::uint32_t>& pair) {
    file.line("off");
    file.value(pair.first);
    file.value(pair.second);
  });
  passAll(file, "maps", audited.cells, {}, [&](RecordedCells& cells) { pass(file, cells); });
  passAll(file, "pairs", audited.pairs, {}, [&](NearPair& pair) { pass(file, pair); });
  passAll(file, "queries", audited.queries, {}, [&](RecordedQuery& query) { pass(file, query); });
  file.line("end");
}

/// Checks that each index of a body or name is less than the number of bodies or names in the case.
void checkIndices(const AuditCase& audited) {
  const std::size_t bodies = audited.bodies.size();
  bool valid = audited.poses.size() == bodies;
  const std::size_t names = audited.names.size();
  for (const RecordedTransform& transform : audited.transforms) {
    valid = valid && transform.parent < names && transform.child < names && transform.publisher < names;
  }
  for (const NearPair& pair : audited.pairs) valid = valid && pair.first < pair.second && pair.second < bodies;
  for (const RecordedCells& cells : audited.cells) valid = valid && cells.body < bodies;
  for (const RecordedQuery& query : audited.queries) {
    valid = valid && query.kind <= RecordedQuery::Kind::nearest;
    for (const RecordedQuery::Hit& hit : query.hits) valid = valid && hit.body < bodies;
  }
  if (!valid)
    throw Refusal(Code::parse, "the audit file is not valid: the number of a body or name is beyond its list");
}

}  // namespace

void writeCase(const AuditCase& audited, std::ostream& out) {
  AuditCase copy = audited;  // passCase() needs a value that it could also change
  CaseWriter writer(out);
  passCase(writer, copy);
  out << '\n';
}

AuditCase readCase(std::istream& in) {
  AuditCase audited;
  CaseReader reader(in);
  passCase(reader, audited);
  checkIndices(audited);
  return audited;
}

}  // namespace hgrid
