// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tools/mesh/dae_file.h"

#include <tinyxml2.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <utility>

#include "adapters/urdf/xml.h"
#include "hgrid_proximity/refusal.h"
#include "tools/mesh/text_numbers.h"

namespace hgrid {
namespace {

using Element = tinyxml2::XMLElement;

constexpr char kBlanks[] = " \t\r\n";

[[noreturn]] void refuse(Code code, const Element& element, const std::string& what) {
  throw Refusal(
      code, std::string("its <") + element.Name() + "> in line " + std::to_string(element.GetLineNum()) + " " + what);
}

[[noreturn]] void refuseUnread(const Element& element) {
  refuse(Code::unsupported, element, "is not read; export plain triangles");
}

bool isNamed(const Element& element, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) { return name == element.Name(); });
}

/// Calls `act` for each child element. Skips <asset> and <extra>, which add no surface anywhere.
template <class Act>
void forChildren(const Element& parent, const Act& act) {
  for (const Element* child = parent.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (!isNamed(*child, {"asset", "extra"})) act(*child);
  }
}

/// Returns the only child element of this name.
/// @throws Refusal parse if there is none, or more than one
const Element& onlyChild(const Element& parent, const char* name) {
  const Element* child = parent.FirstChildElement(name);
  if (child == nullptr) refuse(Code::parse, parent, std::string("must have a <") + name + ">");
  if (const Element* other = child->NextSiblingElement(name)) {
    refuse(Code::parse, *other, std::string("is the second one of its <") + parent.Name() + ">");
  }
  return *child;
}

/// Returns the words that an element contains, each read by `read`.
template <class Read>
auto wordsOf(const Element& element, const Read& read) {
  std::string text;
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToText() != nullptr) text += node->Value();
    if (node->ToElement() != nullptr) refuseUnread(*node->ToElement());
  }
  std::vector<decltype(read(text))> numbers;
  for (std::size_t at = 0, end = 0; (end = nextWord(text, at, kBlanks)) > at; at = end) {
    try {
      numbers.push_back(read(text.substr(at, end - at)));
    } catch (const Refusal& refusal) {
      refuse(refusal.code(), element, std::string("is not valid: ") + refusal.what());
    }
  }
  return numbers;
}
std::vector<double> numbersOf(const Element& element) { return wordsOf(element, readNumber); }
std::vector<std::uint32_t> indicesOf(const Element& element) { return wordsOf(element, readIndex); }

/// Returns the numbers of a transform, which must be `count`.
std::vector<double> numbersOf(const Element& element, std::size_t count) {
  std::vector<double> numbers = numbersOf(element);
  if (numbers.size() == count) return numbers;
  refuse(Code::parse, element,
         "has " + std::to_string(numbers.size()) + " numbers; it must have " + std::to_string(count));
}

/// Returns the only word of an attribute, read by `read`, or `missing` if there is no such attribute.
template <class Read, class Value>
Value attributeOf(const Element& element, const char* name, const Read& read, Value missing) {
  const char* const value = element.Attribute(name);
  if (value == nullptr) return missing;
  const std::string text = value;
  std::size_t begin = 0;
  nextWord(text, begin, kBlanks);
  try {
    return read(text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin));
  } catch (const Refusal& refusal) {
    refuse(refusal.code(), element, std::string("has a wrong ") + name + ": " + refusal.what());
  }
}
std::uint32_t indexAttribute(const Element& element, const char* name, std::uint32_t missing) {
  return attributeOf(element, name, readIndex, missing);
}

void checkCount(const Element& element, std::size_t counted, const char* what) {
  const std::uint32_t count = indexAttribute(element, "count", static_cast<std::uint32_t>(counted));
  if (count == counted) return;
  refuse(Code::parse, element,
         "has count " + std::to_string(count) + ", but contains " + std::to_string(counted) + " " + what);
}

Eigen::Affine3d lookAt(const Element& element) {
  const std::vector<double> n = numbersOf(element, 9);
  const Eigen::Vector3d eye(n[0], n[1], n[2]), interest(n[3], n[4], n[5]), up(n[6], n[7], n[8]);
  const Eigen::Vector3d ahead = (interest - eye).normalized(), right = ahead.cross(up).normalized();
  if (!(ahead.cross(right).norm() > 0.5)) refuse(Code::parse, element, "has no direction, or its up is along it");
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() << right, right.cross(ahead), -ahead;
  pose.translation() = eye;
  return pose;
}

Eigen::Affine3d rotation(const Element& element) {
  const std::vector<double> n = numbersOf(element, 4);
  if (n[3] == 0.0) return Eigen::Affine3d::Identity();  // some programs write axis 0 0 0 then
  const Eigen::Vector3d axis(n[0], n[1], n[2]);
  if (!(axis.norm() > 0.0)) refuse(Code::parse, element, "turns about the axis 0 0 0");
  return Eigen::Affine3d(Eigen::AngleAxisd(n[3] * EIGEN_PI / 180.0, axis.normalized()));
}

Eigen::Affine3d matrix(const Element& element) {
  const std::vector<double> n = numbersOf(element, 16);
  if (n[12] != 0.0 || n[13] != 0.0 || n[14] != 0.0 || n[15] != 1.0) {
    refuse(Code::unsupported, element, "must end with 0 0 0 1");
  }
  Eigen::Affine3d pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data());
  return pose;
}

bool isTransform(const Element& element) {
  return isNamed(element, {"matrix", "translate", "rotate", "scale", "lookat", "skew"});
}

/// Returns the pose of a node by one of its transforms.
Eigen::Affine3d transformOf(const Element& element) {
  if (isNamed(element, {"matrix"})) return matrix(element);
  if (isNamed(element, {"rotate"})) return rotation(element);
  if (isNamed(element, {"lookat"})) return lookAt(element);
  if (isNamed(element, {"skew"})) refuseUnread(element);
  const std::vector<double> n = numbersOf(element, 3);
  const Eigen::Vector3d xyz(n[0], n[1], n[2]);
  if (isNamed(element, {"scale"})) return Eigen::Affine3d(Eigen::Scaling(xyz));
  return Eigen::Affine3d(Eigen::Translation3d(xyz));
}

/// Reads the scene of a document.
class SceneReader {
 public:
  SceneReader(const Element& root, Triangles& triangles) : triangles_(triangles) { collectIds(root); }

  void read(const Element& root) {
    Eigen::Affine3d meters = Eigen::Affine3d::Identity();
    const Element* const asset = root.FirstChildElement("asset");
    const Element* const unit = asset == nullptr ? nullptr : asset->FirstChildElement("unit");
    if (unit != nullptr) {
      const double meter = attributeOf(*unit, "meter", readNumber, 1.0);
      if (!(meter > 0.0)) refuse(Code::parse, *unit, "must be larger than 0 m");
      meters = Eigen::Scaling(meter);
    }
    const Element& instance = onlyChild(onlyChild(root, "scene"), "instance_visual_scene");
    forChildren(target(instance, "url", "visual_scene"), [&](const Element& child) {
      if (isNamed(child, {"node"})) return readNode(child, meters, 0);
      if (!isNamed(child, {"evaluate_scene"})) refuseUnread(child);
    });
  }

 private:
  void collectIds(const Element& element) {
    if (const char* const id = element.Attribute("id")) {
      const auto [known, is_new] = by_id_.try_emplace({element.Name(), id}, &element);
      if (!is_new) known->second = nullptr;  // not unique
    }
    for (const Element* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
      collectIds(*child);
    }
  }

  /// Returns the element of this kind that an attribute refers to.
  /// @throws Refusal parse if it does not name exactly one
  const Element& target(const Element& element, const char* attribute, const char* kind) const {
    const char* const value = element.Attribute(attribute);
    const std::string url = value == nullptr ? "" : value;
    const auto known = by_id_.find({kind, url.substr(std::min<std::size_t>(1, url.size()))});
    if (!url.empty() && url[0] == '#' && known != by_id_.end() && known->second != nullptr) return *known->second;
    refuse(Code::parse, element,
           std::string("has the ") + attribute + " '" + printable(url, 60) + "', which is not '#' and the id of one <" +
               kind + "> of this file");
  }

  void readNode(const Element& node, Eigen::Affine3d mesh_from_node, int depth) {
    if (depth > kDeepest) refuse(Code::limit, node, "lies in too many nodes, or in itself");
    forChildren(node, [&](const Element& child) {
      if (isTransform(child)) mesh_from_node = mesh_from_node * transformOf(child);
    });
    forChildren(node, [&](const Element& child) {
      if (isTransform(child) || isNamed(child, {"instance_camera", "instance_light"})) return;
      if (isNamed(child, {"node"})) return readNode(child, mesh_from_node, depth + 1);
      if (isNamed(child, {"instance_node"})) return readNode(target(child, "url", "node"), mesh_from_node, depth + 1);
      if (isNamed(child, {"instance_geometry"})) {
        return triangles_.add(facesOf(target(child, "url", "geometry")), mesh_from_node);
      }
      refuseUnread(child);
    });
  }

  Faces facesOf(const Element& geometry) const {
    Faces faces;
    forChildren(geometry, [&](const Element& child) {
      if (isNamed(child, {"mesh"})) return addMesh(onlyChild(geometry, "mesh"), faces);
      if (!isNamed(child, {"spline"})) refuseUnread(child);
    });
    return faces;
  }

  void addMesh(const Element& mesh, Faces& faces) const {
    forChildren(mesh, [&](const Element& child) {
      if (isNamed(child, {"source", "vertices", "lines", "linestrips"})) return;
      if (!isNamed(child, {"triangles", "polylist", "polygons", "tristrips", "trifans"})) refuseUnread(child);
      const Element& vertices = onlyChild(mesh, "vertices");
      if (faces.places.empty()) faces.places = placesOf(vertices);
      addFaces(child, vertices, faces);
    });
  }

  /// Returns the places of all vertices.
  std::vector<Eigen::Vector3f> placesOf(const Element& vertices) const {
    const Element* position = nullptr;
    forChildren(vertices, [&](const Element& child) {
      const char* const semantic = child.Attribute("semantic");
      if (semantic == nullptr || std::string(semantic) != "POSITION") return;
      if (position != nullptr) refuse(Code::parse, vertices, "has two inputs of the semantic POSITION");
      position = &child;
    });
    if (position == nullptr) refuse(Code::parse, vertices, "has no input of the semantic POSITION");
    const Element& technique = onlyChild(target(*position, "source", "source"), "technique_common");
    const Element& accessor = onlyChild(technique, "accessor");
    const Element& array = target(accessor, "source", "float_array");
    const std::vector<double> numbers = numbersOf(array);
    checkCount(array, numbers.size(), "numbers");
    checkParams(accessor);
    const std::size_t count = indexAttribute(accessor, "count", 0), stride = indexAttribute(accessor, "stride", 1);
    const std::size_t offset = indexAttribute(accessor, "offset", 0);
    if (stride < 3 || (count > 0 && offset + (count - 1) * stride + 3 > numbers.size())) {
      refuse(
          Code::parse, accessor,
          "takes other numbers than the " + std::to_string(numbers.size()) + " that there are, or no three at a time");
    }
    std::vector<Eigen::Vector3f> places;
    places.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      places.push_back(Eigen::Map<const Eigen::Vector3d>(&numbers[offset + i * stride]).cast<float>());
    }
    return places;
  }

  static void checkParams(const Element& accessor) {
    std::string names;
    forChildren(accessor, [&](const Element& param) {
      const char* const name = param.Attribute("name");
      names += name == nullptr ? "-" : name;
    });
    if (names != "XYZ") refuse(Code::unsupported, accessor, "must have the three params X, Y and Z, in this order");
  }

  void addFaces(const Element& primitive, const Element& vertices, Faces& faces) const {
    std::size_t stride = 1, vertex = 0;
    int vertex_inputs = 0;
    std::vector<std::uint32_t> sizes;                // numbers of corners of the faces of a <polylist>
    std::vector<std::vector<std::uint32_t>> strips;  // for each <p>: the numbers of the vertices
    forChildren(primitive, [&](const Element& child) {
      if (isNamed(child, {"input"})) {
        const std::size_t offset = indexAttribute(child, "offset", 0);
        stride = std::max(stride, offset + 1);
        const char* const semantic = child.Attribute("semantic");
        if (semantic == nullptr || std::string(semantic) != "VERTEX") return;
        if (&target(child, "source", "vertices") != &vertices) {
          refuse(Code::parse, child, "has vertices of another mesh");
        }
        vertex = offset;
        ++vertex_inputs;
      } else if (isNamed(child, {"vcount"})) {
        sizes = indicesOf(child);
      } else if (isNamed(child, {"p"})) {
        strips.push_back(indicesOf(child));
      } else {
        refuseUnread(child);
      }
    });
    if (strips.empty()) return checkCount(primitive, 0, "faces");
    if (vertex_inputs != 1) refuse(Code::parse, primitive, "must have one input of the semantic VERTEX");
    for (std::vector<std::uint32_t>& strip : strips) {
      if (strip.size() % stride != 0) {
        refuse(Code::parse, primitive,
               "has " + std::to_string(strip.size()) + " indices in a <p>; each corner has " + std::to_string(stride));
      }
      for (std::size_t i = 0; i < strip.size() / stride; ++i) strip[i] = strip[i * stride + vertex];
      strip.resize(strip.size() / stride);
    }
    if (isNamed(primitive, {"triangles"})) return addTriangles(primitive, strips, faces);
    if (isNamed(primitive, {"polylist"})) return addPolylist(primitive, sizes, strips, faces);
    checkCount(primitive, strips.size(), "<p>");
    for (const std::vector<std::uint32_t>& strip : strips) {
      if (strip.size() < 3) refuse(Code::parse, primitive, "has a <p> of fewer than 3 corners");
      if (isNamed(primitive, {"polygons"})) {
        faces.corners.insert(faces.corners.end(), strip.begin(), strip.end());
        faces.ends.push_back(faces.corners.size());
        continue;
      }
      const bool fan = isNamed(primitive, {"trifans"});
      for (std::size_t i = 2; i < strip.size(); ++i) {
        const bool turned = !fan && i % 2 == 1;  // every second triangle of a strip names its corners backward
        faces.add(fan ? strip[0] : strip[turned ? i - 1 : i - 2], strip[turned ? i - 2 : i - 1], strip[i]);
      }
    }
  }

  static void addTriangles(const Element& primitive, const std::vector<std::vector<std::uint32_t>>& strips,
                           Faces& faces) {
    std::size_t count = 0;
    for (const std::vector<std::uint32_t>& strip : strips) {
      if (strip.size() % 3 != 0) refuse(Code::parse, primitive, "has a triangle without 3 corners");
      for (std::size_t i = 0; i < strip.size(); i += 3) faces.add(strip[i], strip[i + 1], strip[i + 2]);
      count += strip.size() / 3;
    }
    checkCount(primitive, count, "triangles");
  }

  static void addPolylist(const Element& primitive, const std::vector<std::uint32_t>& sizes,
                          const std::vector<std::vector<std::uint32_t>>& strips, Faces& faces) {
    checkCount(primitive, sizes.size(), "faces");
    std::size_t at = 0;
    const std::vector<std::uint32_t>& corners = strips[0];
    for (const std::uint32_t size : sizes) {
      if (size < 3 || size > corners.size() - at) break;
      faces.corners.insert(faces.corners.end(), corners.begin() + static_cast<std::ptrdiff_t>(at),
                           corners.begin() + static_cast<std::ptrdiff_t>(at + size));
      faces.ends.push_back(faces.corners.size());
      at += size;
    }
    if (strips.size() == 1 && at == corners.size()) return;
    refuse(Code::parse, primitive, "has a <vcount> that does not fit its <p>, or a face of fewer than 3 corners");
  }

  static constexpr int kDeepest = 98;
  std::map<std::pair<std::string, std::string>, const Element*> by_id_;  // by name and id; null: not unique
  Triangles& triangles_;
};

}  // namespace

void readDae(const std::string& data, Triangles& triangles) {
  DescriptionLimits limits;
  limits.max_bytes = data.size();  // the caller has limited it
  tinyxml2::XMLDocument document;
  parseXml(data, limits, "it", "COLLADA", document);
  SceneReader(*document.RootElement(), triangles).read(*document.RootElement());
}

}  // namespace hgrid
