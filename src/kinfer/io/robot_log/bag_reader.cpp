// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/bag_reader.hpp"

#include <map>

#include "kinfer/io/files/file_bytes.hpp"
#include "kinfer/io/robot_log/byte_cursor.hpp"
#include "kinfer/io/robot_log/decompression.hpp"
#include "kinfer/io/robot_log/topic_table.hpp"

namespace kinfer {
namespace {

constexpr std::string_view bag_magic("#ROSBAG V");

enum class BagOpcode : std::uint8_t { none = 0, message = 2, chunk = 5, connection = 7 };

using BagFields = std::map<std::string_view, std::string_view>;

/// "name=value" fields, each behind its length; none where they do not fill the header.
std::optional<BagFields> parse_bag_fields(std::string_view header) {
  BagFields fields;
  ByteCursor cursor(header);
  while (cursor.left() > 0) {
    const std::string_view field = cursor.block<std::uint32_t>();
    const std::size_t equals = field.find('=');
    if (!cursor.good() || equals == std::string_view::npos) return std::nullopt;
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

std::string_view text_field(const BagFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string_view() : found->second;
}

template <class T>
T number_field(const BagFields& fields, std::string_view name) {
  return ByteCursor(text_field(fields, name)).number<T>();
}

class BagReader {
 public:
  BagReader(std::string file, const MessageSink& sink) : topics_(std::move(file), sink) {}

  Result<MessageLog> read(FileBytes& file, std::size_t begin) {
    ByteCursor cursor(file.text());
    cursor.take(begin);
    while (cursor.left() > 0) {
      if (auto done = file.fill_to(cursor.at() + sizeof(std::uint32_t)); !done) return forward_error(done.error());
      const std::string_view header = cursor.block<std::uint32_t>();
      if (auto done = file.fill_to(cursor.at() + sizeof(std::uint32_t)); !done) return forward_error(done.error());
      const std::string_view data = cursor.block<std::uint32_t>();
      if (!cursor.good()) {
        topics_.remark(
            fmt::format("{}: the file ends in the middle of a record; what is before it is used", topics_.file()));
        break;
      }
      if (auto done = file.fill_to(cursor.at()); !done) return forward_error(done.error());
      if (auto done = read_bag_record(header, data, true); !done) return forward_error(done.error());
      topics_.report_progress(cursor.at(), file.text().size());
      file.release_before(cursor.at());
    }
    return topics_.take();
  }

 private:
  Result<void> read_bag_record(std::string_view header, std::string_view data, bool may_be_chunk) {
    const auto fields = parse_bag_fields(header);
    if (!fields) return error("{}: the header of a record is damaged", topics_.file());
    const auto opcode = static_cast<BagOpcode>(number_field<std::uint8_t>(*fields, "op"));
    if (opcode == BagOpcode::message) return read_bag_message(*fields, data);
    if (opcode == BagOpcode::connection) return read_connection(*fields, data);
    if (opcode == BagOpcode::chunk && may_be_chunk) return read_bag_chunk(*fields, data);
    return {};
  }

  Result<void> read_bag_chunk(const BagFields& fields, std::string_view data) {
    const auto records =
        unpacker_.unpack(text_field(fields, "compression"), data, number_field<std::uint32_t>(fields, "size"));
    if (!records) return error("{}: {}", topics_.file(), records.error().what);
    ByteCursor cursor(*records);
    while (cursor.left() > 0) {
      const std::string_view header = cursor.block<std::uint32_t>(), inside = cursor.block<std::uint32_t>();
      if (!cursor.good()) return error("{}: a chunk is damaged", topics_.file());
      if (auto done = read_bag_record(header, inside, false); !done) return done;
    }
    return {};
  }

  Result<void> read_connection(const BagFields& fields, std::string_view data) {
    const auto id = number_field<std::uint32_t>(fields, "conn");
    if (topics_.knows(id)) return {};  // the index repeats the connections
    const auto description = parse_bag_fields(data);
    if (!description) return error("{}: the description of a topic is damaged", topics_.file());
    LoggedTopic topic{.name = std::string(text_field(fields, "topic")),
                      .type = plain_type_name(text_field(*description, "type")),
                      .definition = std::string(text_field(*description, "message_definition")),
                      .serialization = Serialization::ros1};
    return topics_.add(id, std::move(topic));
  }

  Result<void> read_bag_message(const BagFields& fields, std::string_view data) {
    ByteCursor time(text_field(fields, "time"));
    const std::int64_t seconds = time.number<std::uint32_t>(), nanoseconds = time.number<std::uint32_t>();
    return topics_.message(number_field<std::uint32_t>(fields, "conn"), seconds * 1'000'000'000 + nanoseconds, data);
  }

  TopicTable topics_;
  Decompressor unpacker_;
};

}  // namespace

bool is_bag(std::string_view head) {
  return head.starts_with(bag_magic);
}

Result<MessageLog> read_bag(const std::filesystem::path& path, const MessageSink& sink) {
  KINFER_TRY(file, FileBytes::open(path));
  const std::string_view text = file.text(), line = text.substr(0, text.substr(0, 64).find('\n'));
  const std::string_view version = line.substr(std::min(line.size(), bag_magic.size()));
  if (version != "2.0") return error("{}: expected a ROS bag of version 2.0, found \"{}\"", path.string(), line);
  return BagReader(path.string(), sink).read(file, line.size() + 1);
}

}  // namespace kinfer
