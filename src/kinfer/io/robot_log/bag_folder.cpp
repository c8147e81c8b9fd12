// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/bag_folder.hpp"

#include <algorithm>

namespace kinfer {
namespace {

/// "drive_12.mcap": 12; files without a number come first.
long long part_number(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const auto last = stem.find_last_not_of("0123456789");
  const std::string digits = last == std::string::npos ? stem : stem.substr(last + 1);
  constexpr std::size_t most_digits = 12;
  return digits.empty() || digits.size() > most_digits ? -1 : std::stoll(digits);
}

}  // namespace

std::vector<std::filesystem::path> bag_folder_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const std::filesystem::path extension = entry.path().extension();
    if ((extension == ".mcap" || extension == ".db3") && entry.is_regular_file(failure)) files.push_back(entry.path());
  }
  std::ranges::sort(files, {}, [](const std::filesystem::path& file) {
    return std::pair(part_number(file), file.filename().string());
  });
  return files;
}

Result<MessageLog> read_bag_files(const std::vector<std::filesystem::path>& files, const MessageSink& sink,
                                  ReadLog read) {
  MessageLog whole;
  std::vector<bool> wanted;
  for (const std::filesystem::path& file : files) {
    std::vector<std::size_t> number;  // of the file's topics among all
    const MessageSink part{.wants = [&](std::size_t, const LoggedTopic& topic) -> Result<bool> {
                             const auto same = std::ranges::find(whole.topics, topic.name, &LoggedTopic::name);
                             const auto index = static_cast<std::size_t>(same - whole.topics.begin());
                             number.push_back(index);
                             if (same == whole.topics.end()) {
                               KINFER_TRY(is_wanted, sink.wants(index, topic));
                               whole.topics.push_back(topic);
                               wanted.push_back(is_wanted);
                             } else if (same->type != topic.type) {
                               return error("{}: topic {} is of two types, {} and {}", file.string(), topic.name,
                                            same->type, topic.type);
                             }
                             return static_cast<bool>(wanted[index]);
                           },
                           .on_message = [&](const LoggedMessage& message) -> Result<void> {
                             return sink.on_message({number[message.topic], message.log_time, message.data});
                           },
                           .observer = sink.observer};
    KINFER_TRY(log, read(file, part));
    for (std::size_t t = 0; t < log.topics.size() && t < number.size(); ++t) {
      LoggedTopic& topic = whole.topics[number[t]];
      if (log.topics[t].messages == 0) continue;
      if (topic.messages == 0) topic.first_time = log.topics[t].first_time;
      topic.messages += log.topics[t].messages;
      topic.last_time = log.topics[t].last_time;
    }
    whole.remarks.insert(whole.remarks.end(), log.remarks.begin(), log.remarks.end());
  }
  return whole;
}

}  // namespace kinfer
