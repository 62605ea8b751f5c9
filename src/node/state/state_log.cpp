// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/state/state_log.h"

#include <boost/crc.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

const std::string kName = "hgrid_proximity_state ";
const std::string kTitle = kName + "1\n";
// A record begins with a line: this word and three hexadecimal numbers. The first is the number of bytes of the edits,
// the second is the checksum of the edits, and the third is the checksum of the line before the third number.
const std::string kRecord = "record ";
constexpr std::size_t kSize = 7, kChecksum = kSize + 17, kOwnChecksum = kChecksum + 9, kHeader = kOwnChecksum + 9;

std::uint32_t checksumOf(const char* bytes, std::size_t size) {
  boost::crc_32_type checksum;
  checksum.process_bytes(bytes, size);
  return checksum.checksum();
}

std::string hexadecimal(std::uint64_t number, int digits) {
  char text[24];
  std::snprintf(text, sizeof text, "%0*llx", digits, static_cast<unsigned long long>(number));
  return text;
}

/// Reads a number with exactly as many hexadecimal digits as `text` has characters.
std::optional<std::uint64_t> numberOf(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789abcdef") != std::string::npos) return std::nullopt;
  return std::strtoull(text.c_str(), nullptr, 16);
}

char letterOf(StateEdit::Kind kind) {
  switch (kind) {
    case StateEdit::Kind::set:
      return 's';
    case StateEdit::Kind::erase:
      return 'e';
    case StateEdit::Kind::erase_kind:
      break;
  }
  return 'k';
}

std::optional<StateEdit::Kind> kindOf(char letter) {
  for (const auto kind : {StateEdit::Kind::set, StateEdit::Kind::erase, StateEdit::Kind::erase_kind}) {
    if (letterOf(kind) == letter) return kind;
  }
  return std::nullopt;
}

/// Reads texts from the edits of a record. Each text has its length before it.
class Cursor {
 public:
  explicit Cursor(const std::string& bytes) : bytes_(bytes) {}
  bool atEnd() const { return at_ == bytes_.size(); }
  std::optional<std::string> take(std::size_t count) {
    if (count > bytes_.size() - at_) return std::nullopt;
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::optional<std::string> takeText() {
    const auto digits = take(16);
    const auto size = digits ? numberOf(*digits) : std::nullopt;
    return size ? take(*size) : std::nullopt;
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::optional<std::vector<StateEdit>> editsOf(const std::string& bytes) {
  std::vector<StateEdit> edits;
  Cursor cursor(bytes);
  while (!cursor.atEnd()) {
    const auto letter = cursor.take(1);
    const auto kind = kindOf(letter->front());
    const auto key = cursor.takeText();
    const auto text = key ? cursor.takeText() : std::nullopt;
    const auto end = text ? cursor.take(1) : std::nullopt;
    if (!kind || end != "\n") return std::nullopt;
    edits.push_back({*kind, *key, *text});
  }
  return edits;
}

/// What stands at a place of a file.
struct Record {
  enum class State { valid, incomplete, damaged } state = State::incomplete;
  std::size_t end = 0;
  std::vector<StateEdit> edits;
};

Record recordAt(const std::string& bytes, std::size_t at) {
  Record record;
  const std::string header = bytes.substr(at, kHeader);
  if (header.size() < kHeader) return record;
  const auto size = numberOf(header.substr(kSize, 16)), checksum = numberOf(header.substr(kChecksum, 8));
  const auto own_checksum = numberOf(header.substr(kOwnChecksum, 8));
  if (header.compare(0, kSize, kRecord) != 0 || header[kHeader - 1] != '\n' || !size || !checksum ||
      own_checksum != checksumOf(header.data(), kOwnChecksum)) {
    record.state = Record::State::damaged;
    return record;
  }
  if (*size > bytes.size() - at - kHeader) return record;
  record.state = Record::State::damaged;
  const std::string content = bytes.substr(at + kHeader, *size);
  if (checksumOf(content.data(), content.size()) != *checksum) return record;
  auto edits = editsOf(content);
  if (!edits) return record;
  return {Record::State::valid, at + kHeader + static_cast<std::size_t>(*size), std::move(*edits)};
}

/// Returns whether a valid record begins behind `at`.
bool hasRecordBehind(const std::string& bytes, std::size_t at) {
  for (std::size_t next = bytes.find(kRecord, at + 1); next != std::string::npos;
       next = bytes.find(kRecord, next + 1)) {
    if (recordAt(bytes, next).state == Record::State::valid) return true;
  }
  return false;
}

void checkTitle(const std::string& bytes) {
  if (bytes.compare(0, kName.size(), kName) != 0) return;  // recordAt() finds the damage
  const std::string title = bytes.substr(0, bytes.find('\n') + 1);
  if (title.empty() || title == kTitle) return;
  throw Refusal(Code::unsupported, "the file begins with '" + printable(title.substr(0, title.size() - 1), 48) +
                                       "'; this version of the node reads only '" +
                                       kTitle.substr(0, kTitle.size() - 1) + "'");
}

}  // namespace

void applyEdits(const std::vector<StateEdit>& edits, StateItems& items) {
  for (const StateEdit& edit : edits) {
    if (edit.kind == StateEdit::Kind::set) items[edit.key] = edit.text;
    if (edit.kind == StateEdit::Kind::erase) items.erase(edit.key);
    if (edit.kind != StateEdit::Kind::erase_kind) continue;
    auto item = items.lower_bound(edit.key);
    while (item != items.end() && item->first.compare(0, edit.key.size(), edit.key) == 0) item = items.erase(item);
  }
}

std::string beginningOf(const StateItems& items) {
  std::vector<StateEdit> edits;
  for (const auto& [key, text] : items) edits.push_back({StateEdit::Kind::set, key, text});
  return kTitle + recordOf(edits);
}

std::string recordOf(const std::vector<StateEdit>& edits) {
  std::string content;
  for (const StateEdit& edit : edits) {
    content += letterOf(edit.kind);
    content += hexadecimal(edit.key.size(), 16) + edit.key + hexadecimal(edit.text.size(), 16) + edit.text + '\n';
  }
  const std::string header = kRecord + hexadecimal(content.size(), 16) + ' ' +
                             hexadecimal(checksumOf(content.data(), content.size()), 8) + ' ';
  return header + hexadecimal(checksumOf(header.data(), header.size()), 8) + '\n' + content;
}

StateContent readState(const std::string& bytes) {
  checkTitle(bytes);
  StateContent content;
  std::size_t at = kTitle.size();
  if (bytes.compare(0, at, kTitle) != 0) {
    content.damage = "it does not begin with '" + kTitle.substr(0, at - 1) + "'";
    return content;
  }
  while (at < bytes.size()) {
    Record record = recordAt(bytes, at);
    if (record.state != Record::State::valid) {
      if (record.state == Record::State::damaged || hasRecordBehind(bytes, at)) {
        content.damage =
            "the record at byte " + std::to_string(at) + " of " + std::to_string(bytes.size()) + " is damaged";
      }
      return content;
    }
    applyEdits(record.edits, content.items);
    ++content.records;
    at = record.end;
  }
  return content;
}

}  // namespace hgrid
