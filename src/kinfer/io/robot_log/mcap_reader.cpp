// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/mcap_reader.hpp"

#include <unordered_map>

#include "kinfer/io/files/file_bytes.hpp"
#include "kinfer/io/robot_log/byte_cursor.hpp"
#include "kinfer/io/robot_log/decompression.hpp"
#include "kinfer/io/robot_log/topic_table.hpp"

namespace kinfer {
namespace {

constexpr std::string_view mcap_magic("\x89MCAP0\r\n", 8);
constexpr std::size_t record_header = 9;  // opcode and length; longer than the magic that may end the file

enum class McapOpcode : std::uint8_t { schema = 3, channel = 4, message = 5, chunk = 6, data_end = 15 };

struct McapSchema {
  std::string type{}, encoding{}, text{};
};

class McapReader {
 public:
  McapReader(std::string file, const MessageSink& sink) : topics_(std::move(file), sink) {}

  Result<MessageLog> read(FileBytes& file) {
    ByteCursor cursor(file.text());
    cursor.take(mcap_magic.size());
    bool ended = false;
    while (!ended && cursor.left() > 0) {
      if (auto done = file.fill_to(cursor.at() + record_header); !done) return forward_error(done.error());
      if (file.text().substr(cursor.at()) == mcap_magic) break;
      const auto opcode = static_cast<McapOpcode>(cursor.number<std::uint8_t>());
      const std::string_view content = cursor.block<std::uint64_t>();
      if (!cursor.good()) {
        topics_.remark(
            fmt::format("{}: the file ends in the middle of a record; what is before it is used", topics_.file()));
        break;
      }
      if (auto done = file.fill_to(cursor.at()); !done) return forward_error(done.error());
      if (opcode == McapOpcode::chunk) {
        if (auto done = read_chunk(content); !done) return forward_error(done.error());
      } else if (auto done = read_record(opcode, content); !done) {
        return forward_error(done.error());
      }
      ended = opcode == McapOpcode::data_end;  // what follows is an index of what was read
      topics_.report_progress(cursor.at(), file.text().size());
      file.release_before(cursor.at());
    }
    return topics_.take();
  }

 private:
  Result<void> damaged(const char* what) const { return error("{}: a {} record is damaged", topics_.file(), what); }

  Result<void> read_chunk(std::string_view content) {
    ByteCursor cursor(content);
    cursor.take(16);  // times of the first and last message
    const auto size = cursor.number<std::uint64_t>();
    cursor.take(4);  // checksum
    const std::string_view method = cursor.block<std::uint32_t>();
    const std::string_view packed = cursor.block<std::uint64_t>();
    if (!cursor.good()) return damaged("chunk");
    const auto records = unpacker_.unpack(method, packed, size);
    if (!records) return error("{}: {}", topics_.file(), records.error().what);
    ByteCursor inside(*records);
    while (inside.left() > 0) {
      const auto opcode = static_cast<McapOpcode>(inside.number<std::uint8_t>());
      const std::string_view record = inside.block<std::uint64_t>();
      if (!inside.good()) return damaged("chunk");
      if (auto done = read_record(opcode, record); !done) return done;
    }
    return {};
  }

  Result<void> read_record(McapOpcode opcode, std::string_view content) {
    if (opcode == McapOpcode::message) return read_mcap_message(content);
    if (opcode == McapOpcode::schema) return read_schema(content);
    if (opcode == McapOpcode::channel) return read_channel(content);
    return {};
  }

  Result<void> read_schema(std::string_view content) {
    ByteCursor cursor(content);
    const auto id = cursor.number<std::uint16_t>();
    McapSchema schema;
    schema.type = plain_type_name(cursor.block<std::uint32_t>());
    schema.encoding = cursor.block<std::uint32_t>();
    schema.text = cursor.block<std::uint32_t>();
    if (!cursor.good()) return damaged("schema");
    schemas_[id] = std::move(schema);
    return {};
  }

  Result<void> read_channel(std::string_view content) {
    ByteCursor cursor(content);
    const auto id = cursor.number<std::uint16_t>();
    const McapSchema& schema = schemas_[cursor.number<std::uint16_t>()];
    const std::string_view name = cursor.block<std::uint32_t>(), encoding = cursor.block<std::uint32_t>();
    if (!cursor.good()) return damaged("channel");
    if (topics_.knows(id)) return {};
    LoggedTopic topic{.name = std::string(name), .type = schema.type};
    const bool has_text = schema.encoding == "ros1msg" || schema.encoding == "ros2msg";
    if (has_text) topic.definition = schema.text;
    topic.serialization = encoding == "ros1"  ? Serialization::ros1
                          : encoding == "cdr" ? Serialization::cdr
                                              : Serialization::other;
    return topics_.add(id, std::move(topic));
  }

  Result<void> read_mcap_message(std::string_view content) {
    ByteCursor cursor(content);
    const auto channel = cursor.number<std::uint16_t>();
    cursor.take(4);  // sequence number
    const auto log_time = static_cast<std::int64_t>(cursor.number<std::uint64_t>());
    cursor.take(8);  // publish time
    if (!cursor.good()) return damaged("message");
    return topics_.message(channel, log_time, content.substr(cursor.at()));
  }

  TopicTable topics_;
  std::unordered_map<std::uint16_t, McapSchema> schemas_;
  Decompressor unpacker_;
};

}  // namespace

bool is_mcap(std::string_view head) {
  return head.starts_with(mcap_magic);
}

Result<MessageLog> read_mcap(const std::filesystem::path& path, const MessageSink& sink) {
  KINFER_TRY(file, FileBytes::open(path));
  return McapReader(path.string(), sink).read(file);
}

}  // namespace kinfer
