// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/topic_table.hpp"

#include <algorithm>

namespace kinfer {

Result<void> TopicTable::add(std::uint64_t id, LoggedTopic topic) {
  const auto same = std::ranges::find(log_.topics, topic.name, &LoggedTopic::name);
  if (same != log_.topics.end()) {
    if (same->type != topic.type)
      return error("{}: topic {} is of two types, {} and {}", file_, topic.name, same->type, topic.type);
    by_id_[id] = static_cast<std::size_t>(same - log_.topics.begin());
    return {};
  }
  const std::size_t index = log_.topics.size();
  auto wanted = sink_.wants(index, topic);
  if (!wanted) return error("{}: {}", file_, wanted.error().what);
  log_.topics.push_back(std::move(topic));
  wanted_.push_back(*wanted);
  by_id_[id] = index;
  return {};
}

bool TopicTable::is_wanted(std::uint64_t id) const {
  const auto found = by_id_.find(id);
  return found != by_id_.end() && wanted_[found->second];
}

Result<void> TopicTable::message(std::uint64_t id, std::int64_t log_time, std::string_view data) {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return {};  // of a channel that the file does not declare
  LoggedTopic& topic = log_.topics[found->second];
  if (topic.messages++ == 0) topic.first_time = log_time;
  topic.last_time = log_time;
  if (!wanted_[found->second]) return {};
  return sink_.on_message({found->second, log_time, data});
}

std::string plain_type_name(std::string_view type) {
  std::string name(type);
  if (const auto at = name.find("/msg/"); at != std::string::npos) name.replace(at, 5, "/");
  return name;
}

}  // namespace kinfer
