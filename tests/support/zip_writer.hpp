// SPDX-License-Identifier: Apache-2.0
// Zip archives of deflated files, as phones export them.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kinfer::test {

inline void put_number(std::string& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i));
}

inline std::string deflated(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(packed.size() - stream.avail_out);
  deflateEnd(&stream);
  return packed;
}

/// Method, time, date, checksum, sizes and length of the name: what both headers of a file have.
inline std::string shared_fields(const std::pair<std::string, std::string>& file, std::size_t packed) {
  std::string bytes;
  for (const std::uint32_t field : {20U, 0U, 8U, 0U, 33U}) put_number(bytes, field, 2);
  put_number(bytes,
             static_cast<std::uint32_t>(
                 crc32(0, reinterpret_cast<const Bytef*>(file.second.data()), static_cast<uInt>(file.second.size()))),
             4);
  put_number(bytes, static_cast<std::uint32_t>(packed), 4);
  put_number(bytes, static_cast<std::uint32_t>(file.second.size()), 4);
  put_number(bytes, static_cast<std::uint32_t>(file.first.size()), 2);
  put_number(bytes, 0, 2);
  return bytes;
}

/// `files`: name and text.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string archive, directory;
  for (const auto& file : files) {
    const std::string packed = deflated(file.second), fields = shared_fields(file, packed.size());
    directory += std::string("PK\x01\x02\x14\0", 6) + fields;
    for (int i = 0; i < 10; ++i) directory += '\0';
    put_number(directory, static_cast<std::uint32_t>(archive.size()), 4);
    directory += file.first;
    archive += std::string("PK\x03\x04", 4) + fields + file.first + packed;
  }
  std::string end("PK\x05\x06\0\0\0\0", 8);
  for (int i = 0; i < 2; ++i) put_number(end, static_cast<std::uint32_t>(files.size()), 2);
  put_number(end, static_cast<std::uint32_t>(directory.size()), 4);
  put_number(end, static_cast<std::uint32_t>(archive.size()), 4);
  put_number(end, 0, 2);
  return archive + directory + end;
}

}  // namespace kinfer::test
