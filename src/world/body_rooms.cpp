// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/world/body_rooms.h"

#include <algorithm>
#include <bitset>
#include <utility>

namespace hgrid {
namespace {

constexpr std::size_t kWord = 64;  // bits

}  // namespace

BodyRooms::BodyRooms(std::shared_ptr<const Building> building, std::size_t bodies)
    : building_(std::move(building)),
      words_(building_->rooms().size() / kWord + 1),
      bits_(bodies * words_, ~std::uint64_t{0}) {}

bool BodyRooms::areSeparate(std::uint32_t first, std::uint32_t second) const {
  std::uint64_t common = 0;
  for (std::size_t word = 0; word < words_; ++word)
    common |= bits_[first * words_ + word] & bits_[second * words_ + word];
  return common == 0;
}

bool BodyRooms::bit(std::uint32_t body, std::size_t room) const {
  return (bits_[body * words_ + room / kWord] >> (room % kWord) & 1) != 0;
}

bool BodyRooms::isAnywhere(std::uint32_t body) const { return bit(body, building_->rooms().size()); }

std::vector<std::uint32_t> BodyRooms::roomsOf(std::uint32_t body) const {
  std::vector<std::uint32_t> rooms;
  for (std::uint32_t room = 0; room < building_->rooms().size(); ++room) {
    if (bit(body, room)) rooms.push_back(room);
  }
  return rooms;
}

bool BodyRooms::has(std::uint32_t body, const std::vector<std::uint32_t>& rooms) const {
  if (rooms.empty() || isAnywhere(body)) return rooms.empty() && isAnywhere(body);
  std::size_t count = 0;
  for (std::size_t word = 0; word < words_; ++word) count += std::bitset<kWord>(bits_[body * words_ + word]).count();
  const auto has_bit = [&](std::uint32_t room) { return bit(body, room); };
  return count == rooms.size() && std::all_of(rooms.begin(), rooms.end(), has_bit);
}

void BodyRooms::set(std::uint32_t body, const std::vector<std::uint32_t>& rooms) {
  const auto begin = bits_.begin() + static_cast<std::ptrdiff_t>(body * words_);
  std::fill(begin, begin + static_cast<std::ptrdiff_t>(words_), rooms.empty() ? ~std::uint64_t{0} : 0);
  for (const std::uint32_t room : rooms) bits_[body * words_ + room / kWord] |= std::uint64_t{1} << (room % kWord);
}

}  // namespace hgrid
