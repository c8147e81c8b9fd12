// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/compressed_text.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>

namespace kinfer {
namespace {

constexpr std::string_view zstd_magic("\x28\xB5\x2F\xFD", 4);
constexpr std::size_t largest_text = std::size_t{8} << 30;

using Stream = std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)>;

/// Unpacks until the input or `most` is reached; whether the last frame is complete, or what is wrong.
enum class UnpackEnd { complete, cut_off, damaged };
UnpackEnd unpack_into(std::string_view packed, std::size_t most, std::string& text) {
  const Stream stream(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  // A window of 128 MiB is what the format's own tools accept without being told.
  if (!stream || ZSTD_isError(ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, 27))) return UnpackEnd::damaged;
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t left = 1;
  // A frame that states its size is given that much at once, but never more than its packed size could plausibly need.
  constexpr unsigned long long usual_ratio = 16;
  const unsigned long long stated = ZSTD_getFrameContentSize(packed.data(), packed.size());
  const bool is_plausible = stated <= usual_ratio * packed.size() + ZSTD_DStreamOutSize();
  std::size_t room = std::min(most, is_plausible ? static_cast<std::size_t>(stated) + 1 : 4 * packed.size());
  while (in.pos < in.size && text.size() < most) {
    const std::size_t before = text.size();
    text.resize(std::min(most, std::max(room, before + before / 2 + ZSTD_DStreamOutSize())));
    ZSTD_outBuffer out{text.data(), text.size(), before};
    while (in.pos < in.size && out.pos < out.size) {
      left = ZSTD_decompressStream(stream.get(), &out, &in);
      if (ZSTD_isError(left)) break;
    }
    text.resize(out.pos);
    if (ZSTD_isError(left)) return UnpackEnd::damaged;
  }
  // What was consumed may still wait to be flushed.
  while (left > 0 && !ZSTD_isError(left) && text.size() < most) {
    const std::size_t before = text.size();
    text.resize(std::min(most, before + ZSTD_DStreamOutSize()));
    ZSTD_outBuffer out{text.data(), text.size(), before};
    left = ZSTD_decompressStream(stream.get(), &out, &in);
    text.resize(out.pos);
    if (out.pos == before) break;
  }
  return ZSTD_isError(left) ? UnpackEnd::damaged : left == 0 ? UnpackEnd::complete : UnpackEnd::cut_off;
}

}  // namespace

bool is_zstd(std::string_view head) {
  return head.starts_with(zstd_magic);
}

bool is_gzip(std::string_view head) {
  return head.starts_with("\x1F\x8B\x08");
}

tl::unexpected<Error> packed_by_gzip(const std::string& name) {
  return error("{}: compressed by gzip, which is not read; unpack it (gunzip), or compress it by zstd", name);
}

Result<std::string> unpack_zstd_text(std::string_view packed, const std::string& name) {
  std::string text;
  const UnpackEnd end = unpack_into(packed, largest_text, text);
  if (text.size() >= largest_text) return error("{}: unpacked it is larger than {} bytes", name, largest_text);
  if (end == UnpackEnd::damaged) return error("{}: the compressed file is damaged", name);
  if (end == UnpackEnd::cut_off) return error("{}: the compressed file is cut off", name);
  if (text.empty()) return error("{}: the file is empty", name);
  return text;
}

std::string unpack_zstd_head(std::string_view packed, std::size_t most) {
  std::string text;
  static_cast<void>(unpack_into(packed, most, text));
  return text;
}

}  // namespace kinfer
