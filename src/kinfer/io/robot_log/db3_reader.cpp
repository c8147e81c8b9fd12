// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/db3_reader.hpp"

#include <sqlite3.h>

#include <map>
#include <memory>

#include "kinfer/io/robot_log/topic_table.hpp"

namespace kinfer {
namespace {

constexpr std::string_view sqlite_magic("SQLite format 3\0", 16);

class Database {
 public:
  static Result<Database> open(const std::filesystem::path& path) {
    sqlite3* handle = nullptr;
    const int state = sqlite3_open_v2(path.c_str(), &handle, SQLITE_OPEN_READONLY, nullptr);
    Database database(handle);
    if (state != SQLITE_OK) return error("{}: {}", path.string(), sqlite3_errmsg(handle));
    return database;
  }

  /// Calls on_row(statement) for each row; an error of SQLite, or of on_row, ends it.
  template <class OnRow>
  Result<void> query(const std::string& text, const std::string& file, OnRow on_row) {
    sqlite3_stmt* raw = nullptr;
    const int prepared = sqlite3_prepare_v2(handle_.get(), text.c_str(), -1, &raw, nullptr);
    const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> statement(raw, &sqlite3_finalize);
    if (prepared != SQLITE_OK) return error("{}: no ROS 2 bag: {}", file, sqlite3_errmsg(handle_.get()));
    int state = SQLITE_ROW;
    while ((state = sqlite3_step(raw)) == SQLITE_ROW)
      if (auto done = on_row(raw); !done) return done;
    if (state != SQLITE_DONE) return error("{}: {}", file, sqlite3_errmsg(handle_.get()));
    return {};
  }

 private:
  explicit Database(sqlite3* handle) : handle_(handle, &sqlite3_close) {}
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> handle_;
};

std::string text_of(sqlite3_stmt* row, int column) {
  const void* data = sqlite3_column_blob(row, column);
  const int size = sqlite3_column_bytes(row, column);
  return data ? std::string(static_cast<const char*>(data), static_cast<std::size_t>(size)) : std::string();
}

/// Text of each message type, where the bag stores it.
Result<std::map<std::string, std::string>> read_definitions(Database& database, const std::string& file) {
  bool exists = false;
  auto done = database.query("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'message_definitions'", file,
                             [&](sqlite3_stmt*) -> Result<void> {
                               exists = true;
                               return {};
                             });
  std::map<std::string, std::string> definitions;
  if (done && exists)
    done = database.query(
        "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE encoding = 'ros2msg'", file,
        [&](sqlite3_stmt* row) -> Result<void> {
          definitions[plain_type_name(text_of(row, 0))] = text_of(row, 1);
          return {};
        });
  if (!done) return forward_error(done.error());
  return definitions;
}

}  // namespace

bool is_db3(std::string_view head) {
  return head.starts_with(sqlite_magic);
}

Result<MessageLog> read_db3(const std::filesystem::path& path, const MessageSink& sink) {
  const std::string file = path.string();
  KINFER_TRY(database, Database::open(path));
  KINFER_TRY(definitions, read_definitions(database, file));
  TopicTable topics(file, sink);
  auto done =
      database.query("SELECT id, name, type, serialization_format FROM topics ORDER BY id", file,
                     [&](sqlite3_stmt* row) -> Result<void> {
                       LoggedTopic topic{.name = text_of(row, 1), .type = plain_type_name(text_of(row, 2))};
                       topic.definition = definitions[topic.type];
                       if (text_of(row, 3) != "cdr") topic.serialization = Serialization::other;
                       return topics.add(static_cast<std::uint64_t>(sqlite3_column_int64(row, 0)), std::move(topic));
                     });
  if (!done) return forward_error(done.error());
  std::size_t rows = 0, read = 0;
  done = database.query("SELECT count(*) FROM messages", file, [&](sqlite3_stmt* row) -> Result<void> {
    rows = static_cast<std::size_t>(sqlite3_column_int64(row, 0));
    return {};
  });
  if (!done) return forward_error(done.error());
  done = database.query(
      "SELECT topic_id, timestamp, data FROM messages ORDER BY id", file, [&](sqlite3_stmt* row) -> Result<void> {
        if ((++read & 0x3ff) == 0) topics.report_progress(read, rows);
        const void* data = sqlite3_column_blob(row, 2);
        const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, 2));
        return topics.message(static_cast<std::uint64_t>(sqlite3_column_int64(row, 0)), sqlite3_column_int64(row, 1),
                              data ? std::string_view(static_cast<const char*>(data), size) : std::string_view());
      });
  if (!done) return forward_error(done.error());
  return topics.take();
}

}  // namespace kinfer
