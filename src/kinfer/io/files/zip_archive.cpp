// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/files/zip_archive.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace kinfer {
namespace {

constexpr std::string_view local_mark("PK\x03\x04", 4), directory_mark("PK\x01\x02", 4), end_mark("PK\x05\x06", 4);
constexpr std::size_t local_size = 30, directory_size = 46, end_size = 22;
constexpr std::uint64_t largest_entry = std::uint64_t{1} << 30;
constexpr std::uint32_t in_zip64 = 0xFFFFFFFF;

/// Little-endian number at an offset that is inside.
template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value =
        static_cast<T>(value | static_cast<T>(static_cast<T>(static_cast<unsigned char>(bytes[at + i])) << (8 * i)));
  return value;
}

/// Whether unpacking a file of this name could write outside the folder it is unpacked into.
bool leads_out(std::string_view name) {
  if (name.empty() || name.front() == '/' || name.front() == '\\' || name.find(':') != std::string_view::npos)
    return true;
  for (std::size_t at = 0; at <= name.size();) {
    const std::size_t end = std::min(name.find_first_of("/\\", at), name.size());
    if (name.substr(at, end - at) == "..") return true;
    at = end + 1;
  }
  return false;
}

/// Unpacks a raw deflate stream piece by piece: memory grows with what really comes out.
Result<std::string> inflated(std::string_view packed, std::uint64_t stated, const std::string& where) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return error("{}: no memory to unpack it", where);
  std::string text;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  while (state == Z_OK && text.size() <= stated) {
    constexpr std::size_t piece = std::size_t{1} << 18;
    const std::size_t before = text.size();
    text.resize(before + piece);
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + before);
    stream.avail_out = static_cast<uInt>(piece);
    state = inflate(&stream, Z_NO_FLUSH);
    text.resize(before + piece - stream.avail_out);
    if (state == Z_OK && stream.avail_in == 0 && stream.avail_out > 0) break;  // cut off
  }
  inflateEnd(&stream);
  if (text.size() > stated) return error("{}: it states {} bytes, but holds more", where, stated);
  if (state != Z_STREAM_END || text.size() != stated) return error("{}: the zip archive is damaged here", where);
  return text;
}

}  // namespace

bool is_zip(std::string_view head) {
  return head.starts_with(local_mark) || head.starts_with(end_mark);
}

Result<std::vector<ZipEntry>> zip_entries(std::string_view archive, const std::string& name) {
  const std::size_t end = archive.rfind(end_mark);
  if (end == std::string_view::npos || archive.size() - end < end_size)
    return error("{}: the zip archive is cut off: it has no directory", name);
  const auto count = number_at<std::uint16_t>(archive, end + 10);
  std::uint64_t at = number_at<std::uint32_t>(archive, end + 16);
  if (at == in_zip64) return error("{}: zip64 archives are not read; unpack it", name);
  std::vector<ZipEntry> entries;
  for (std::uint16_t i = 0; i < count; ++i) {
    if (at + directory_size > archive.size() || archive.substr(at, 4) != directory_mark)
      return error("{}: the directory of the zip archive is damaged", name);
    const std::size_t name_size = number_at<std::uint16_t>(archive, at + 28);
    if (at + directory_size + name_size > archive.size())
      return error("{}: the directory of the zip archive is damaged", name);
    ZipEntry entry{.name = std::string(archive.substr(at + directory_size, name_size)),
                   .offset = number_at<std::uint32_t>(archive, at + 42),
                   .packed = number_at<std::uint32_t>(archive, at + 20),
                   .unpacked = number_at<std::uint32_t>(archive, at + 24),
                   .method = number_at<std::uint16_t>(archive, at + 10),
                   .is_encrypted = (number_at<std::uint16_t>(archive, at + 8) & 1) != 0};
    if (leads_out(entry.name))
      return error("{}: the archive names a file \"{}\", which leads out of it; it is not read", name, entry.name);
    if (entry.packed == in_zip64 || entry.unpacked == in_zip64 || entry.offset == in_zip64)
      return error("{}: zip64 archives are not read; unpack it", name);
    at += directory_size + name_size + number_at<std::uint16_t>(archive, at + 30) +
          number_at<std::uint16_t>(archive, at + 32);
    if (!entry.name.ends_with('/')) entries.push_back(std::move(entry));
  }
  return entries;
}

Result<std::string> unpack_zip_entry(std::string_view archive, const ZipEntry& entry, const std::string& name) {
  const std::string where = fmt::format("{}: {}", name, entry.name);
  if (entry.is_encrypted) return error("{}: it is encrypted", where);
  if (entry.unpacked > largest_entry || entry.packed > largest_entry)
    return error("{}: it states {} bytes; more than {} are not read", where, entry.unpacked, largest_entry);
  if (entry.offset + local_size > archive.size() || archive.substr(entry.offset, 4) != local_mark)
    return error("{}: the zip archive is damaged here", where);
  const std::uint64_t begin = entry.offset + local_size + number_at<std::uint16_t>(archive, entry.offset + 26) +
                              number_at<std::uint16_t>(archive, entry.offset + 28);
  if (begin + entry.packed > archive.size()) return error("{}: the zip archive is cut off here", where);
  const std::string_view packed = archive.substr(begin, entry.packed);
  constexpr std::uint16_t stored = 0, deflated = 8;
  if (entry.method == stored && entry.packed == entry.unpacked) return std::string(packed);
  if (entry.method == deflated) return inflated(packed, entry.unpacked, where);
  return error("{}: compression method {} is unknown; known are stored and deflated", where, entry.method);
}

}  // namespace kinfer
