// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/temporary_paths.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <utility>

namespace kinfer {
namespace {

// A table of fixed size without a lock: a signal handler reads it, whatever it interrupts.
std::array<std::atomic<char*>, 256> registered{};

int register_path(const std::string& path) {
  auto copy = std::make_unique<char[]>(path.size() + 1);
  path.copy(copy.get(), path.size());
  for (std::size_t slot = 0; slot < registered.size(); ++slot)
    if (char* none = nullptr; registered[slot].compare_exchange_strong(none, copy.get())) {
      copy.release();  // NOLINT(bugprone-unused-return-value): the table owns it
      return static_cast<int>(slot);
    }
  return -1;
}

}  // namespace

TemporaryPath::TemporaryPath(const std::filesystem::path& path) {
  std::error_code failure;
  path_ = std::filesystem::absolute(path, failure).string();
  if (!failure) slot_ = register_path(path_);
}

TemporaryPath::TemporaryPath(TemporaryPath&& other) noexcept
    : path_(std::move(other.path_)), slot_(std::exchange(other.slot_, -1)) {}

TemporaryPath::~TemporaryPath() {
  if (slot_ >= 0) delete[] registered[static_cast<std::size_t>(slot_)].exchange(nullptr);
}

void remove_temporary_paths() noexcept {
  for (std::size_t slot = registered.size(); slot-- > 0;)
    if (const char* path = registered[slot].load())
      if (::unlink(path) != 0) ::rmdir(path);
}

}  // namespace kinfer
