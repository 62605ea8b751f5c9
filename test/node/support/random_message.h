// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/builtin_message_traits.h>
#include <ros/serialization.h>

#include <boost/array.hpp>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace hgrid {
namespace test {

/// Fills a message of any generated type. Numbers get bits of the source, lists 0 to 3 elements, strings 0 to 21 bytes.
/// @tparam Source  a function object that returns 64 bits
template <class Source>
class FilledMessage {
 public:
  explicit FilledMessage(Source source) : random_(std::move(source)) {}

  template <class Message>
  Message make() {
    Message message;
    next(message);
    return message;
  }
  template <class Field>
  void next(Field& field) {
    if constexpr (std::is_arithmetic_v<Field>) {
      const std::uint64_t bits = random_();
      std::memcpy(&field, &bits, sizeof(field));
    } else {
      ros::serialization::Serializer<Field>::template allInOne<FilledMessage, Field&>(*this, field);
    }
  }
  void next(ros::Time& time) { time = ros::Time(length(), length()); }
  void next(ros::Duration& duration) { duration = ros::Duration(length(), length()); }
  void next(std::string& text) { text.assign(length() * 7, static_cast<char>(random_())); }
  template <class Element>
  void next(std::vector<Element>& list) {
    list.resize(length());
    for (Element& element : list) next(element);
  }
  template <class Element, std::size_t Size>
  void next(boost::array<Element, Size>& list) {
    for (Element& element : list) next(element);
  }

 private:
  std::uint32_t length() { return static_cast<std::uint32_t>(random_() % 4); }

  Source random_;
};

/// Fills a message with random values.
class RandomMessage : public FilledMessage<std::mt19937_64> {
 public:
  explicit RandomMessage(unsigned seed) : FilledMessage(std::mt19937_64(seed)) {}
};

/// Finds the length fields of strings and lists in a serialized message. A position is an offset in bytes.
class LengthPositions {
 public:
  template <class Message>
  static std::vector<std::size_t> of(Message message) {
    LengthPositions positions;
    positions.next(message);
    return positions.found_;
  }
  template <class Field>
  void next(Field& field) {
    if constexpr (ros::message_traits::IsFixedSize<Field>::value) {
      at_ += ros::serialization::serializationLength(field);
    } else {
      ros::serialization::Serializer<Field>::template allInOne<LengthPositions, Field&>(*this, field);
    }
  }
  void next(std::string& text) {
    found_.push_back(at_);
    at_ += 4 + text.size();
  }
  template <class Element>
  void next(std::vector<Element>& list) {
    found_.push_back(at_);
    at_ += 4;
    for (Element& element : list) next(element);
  }

 private:
  std::size_t at_ = 0;
  std::vector<std::size_t> found_;
};

}  // namespace test
}  // namespace hgrid
