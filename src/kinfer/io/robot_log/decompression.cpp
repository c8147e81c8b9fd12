// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/decompression.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cstdint>
#include <optional>

namespace kinfer {
namespace {

constexpr std::uint64_t largest_chunk = std::uint64_t{1} << 30;

/// Each unpacks into `to` and returns the number of bytes; none where the bytes are damaged or do not fit.
std::optional<std::size_t> unpack_zstd(std::string_view from, char* to, std::size_t size) {
  const std::size_t done = ZSTD_decompress(to, size, from.data(), from.size());
  return ZSTD_isError(done) ? std::nullopt : std::optional(done);
}

std::optional<std::size_t> unpack_lz4(std::string_view from, char* to, std::size_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) return std::nullopt;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(context,
                                                                                   &LZ4F_freeDecompressionContext);
  std::size_t written = 0;
  while (!from.empty()) {
    std::size_t consumed = from.size(), produced = size - written;
    const std::size_t state = LZ4F_decompress(context, to + written, &produced, from.data(), &consumed, nullptr);
    if (LZ4F_isError(state)) return std::nullopt;
    written += produced;
    from.remove_prefix(consumed);
    if (state == 0) break;                                    // the frame is complete
    if (consumed == 0 && produced == 0) return std::nullopt;  // more than `size`
  }
  return written;
}

std::optional<std::size_t> unpack_bz2(std::string_view from, char* to, std::size_t size) {
  auto produced = static_cast<unsigned>(size);
  const int state = BZ2_bzBuffToBuffDecompress(to, &produced, const_cast<char*>(from.data()),
                                               static_cast<unsigned>(from.size()), 0, 0);
  return state == BZ_OK ? std::optional<std::size_t>(produced) : std::nullopt;
}

using Unpack = std::optional<std::size_t> (*)(std::string_view, char*, std::size_t);

Unpack unpack_named(std::string_view method) {
  return method == "zstd" ? unpack_zstd : method == "lz4" ? unpack_lz4 : method == "bz2" ? unpack_bz2 : nullptr;
}

}  // namespace

Result<std::string_view> Decompressor::unpack(std::string_view method, std::string_view packed, std::uint64_t size) {
  if (method.empty() || method == "none") return packed;
  const Unpack unpack = unpack_named(method);
  if (!unpack) return error("compression \"{}\" is unknown; known are none, zstd, lz4 and bz2", method);
  if (size > largest_chunk || packed.size() > largest_chunk)
    return error("a chunk states a size of {} bytes; more than {} are not read", size, largest_chunk);
  const auto wanted = static_cast<std::size_t>(size);
  if (wanted > capacity_) {
    // Not filled with zeros: pages that are never written cost no memory, whatever size a chunk states.
    buffer_ = std::make_unique_for_overwrite<char[]>(wanted);
    capacity_ = wanted;
  }
  const auto done = unpack(packed, buffer_.get(), wanted);
  if (!done) return error("a chunk that is compressed by {} is damaged", method);
  if (*done != wanted) return error("a chunk states {} bytes, but holds {}", size, *done);
  return std::string_view(buffer_.get(), wanted);
}

}  // namespace kinfer
