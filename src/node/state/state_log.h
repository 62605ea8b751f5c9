// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "node/state/state_edit.h"

namespace hgrid {

// A file of ~state_folder consists of a title and records. A record consists of a line, which contains the length and
// the checksum (CRC-32) of the record, and of edits. All edits of a record are applied, or none of them. The first
// record holds everything that was stored when the file was begun; later records are appended to it.

/// Returns the title of the file with a first record.
std::string beginningOf(const StateItems& items);
/// Returns a record. Applying it to the items of the records before it gives the items after the edits.
std::string recordOf(const std::vector<StateEdit>& edits);

/// What a file contains.
struct StateContent {
  StateItems items;         ///< after the last valid record
  std::size_t records = 0;  ///< number of valid records; 0: the file has no content that can be used
  /// Why bytes at the end of the file were not used; empty: all were used, or the last record is incomplete. A record
  /// is incomplete if the process ended while it was being written; nobody was told that it was stored.
  std::string damage;
};

/// Reads the bytes of a file up to the first record that is not valid.
/// @throws Refusal unsupported if the file was written by another version of this format
StateContent readState(const std::string& bytes);

}  // namespace hgrid
