// SPDX-License-Identifier: Apache-2.0
// Every reader of the program as a function of bytes, with what must hold of it for any bytes: it returns, and what it
// accepts can be written and read again.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace kinfer::fuzz {

struct Reader {
  std::string_view name;  ///< also of its folder of the corpus
  void (*read)(const std::string& bytes);
};

/// The table: one row a reader.
std::span<const Reader> readers();

/// Null where there is none of this name.
const Reader* find_reader(std::string_view name);

}  // namespace kinfer::fuzz
