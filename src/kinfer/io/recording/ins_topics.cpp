// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_topics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "kinfer/io/recording/foreign/ins_remarks.hpp"
#include "kinfer/io/robot_log/message_decoder.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"

namespace kinfer {
namespace {

constexpr float not_measured = std::numeric_limits<float>::quiet_NaN();
constexpr double microtesla = 1e6;  // per tesla

struct ImuRow {
  std::int64_t time = 0;
  std::array<float, 3> acceleration{}, angular_velocity{};
};
struct MagneticRow {
  std::int64_t time = 0;
  std::array<float, 3> field{};
};

/// What one topic gave.
template <class Row>
struct TopicRows {
  std::string topic{}, frame{};
  MessageDecoder decoder;
  std::vector<Row> rows{};
};

using ImuTopic = TopicRows<ImuRow>;
using MagneticTopic = TopicRows<MagneticRow>;

constexpr std::array<WantedField, 10> imu_fields{{{"header.stamp", FieldBase::time},
                                                  {"header.frame_id", FieldBase::text},
                                                  {"angular_velocity.x"},
                                                  {"angular_velocity.y"},
                                                  {"angular_velocity.z"},
                                                  {"linear_acceleration.x"},
                                                  {"linear_acceleration.y"},
                                                  {"linear_acceleration.z"},
                                                  {"angular_velocity_covariance", FieldBase::number, true},
                                                  {"linear_acceleration_covariance", FieldBase::number, true}}};
constexpr std::array<WantedField, 5> magnetic_fields{{{"header.stamp", FieldBase::time},
                                                      {"header.frame_id", FieldBase::text},
                                                      {"magnetic_field.x"},
                                                      {"magnetic_field.y"},
                                                      {"magnetic_field.z"}}};

/// Three numbers from the field `first` on; not a number where the covariance says that nothing is measured (−1).
std::array<float, 3> triad_of(const std::vector<DecodedField>& fields, std::size_t first, double factor,
                              const DecodedField* covariance) {
  std::array<float, 3> triad;
  const bool is_measured = !covariance || covariance->numbers.empty() || covariance->numbers[0] != -1.0;
  for (std::size_t k = 0; k < 3; ++k)
    triad[k] = is_measured ? static_cast<float>(factor * fields[first + k].numbers[0]) : not_measured;
  return triad;
}

class InsTopicReader {
 public:
  InsTopicReader(std::string file, std::span<const std::string> asked) : file_(std::move(file)), asked_(asked) {}

  Result<void> read(const std::filesystem::path& path, const Observer& observer) {
    const MessageSink sink{
        .wants = [&](std::size_t index, const LoggedTopic& topic) { return add_topic(index, topic); },
        .on_message = [&](const LoggedMessage& message) { return add_message(message); },
        .observer = observer};
    auto log = read_message_log(path, sink);
    if (!log) return forward_error(log.error());
    remarks_ = log->remarks;
    for (const std::string& name : asked_)
      if (std::ranges::find(log->topics, name, &LoggedTopic::name) == log->topics.end())
        return error("{}: there is no topic {}; the topics are {}", file_, name, list_of(*log));
    std::erase_if(imus_, [](const auto& imu) { return imu.second.rows.empty(); });
    if (imus_.empty())
      return error("{}: no topic of sensor_msgs/Imu has messages; the topics are {}", file_, list_of(*log));
    return {};
  }

  /// Adds loggers and sensors; returns the first of these sensors.
  std::size_t append(InsRecording& recording) {
    std::vector<std::string> names;
    for (const auto& [index, imu] : imus_) names.push_back(imu.topic);
    names = is_written_by_kinfer() ? frames() : short_topic_names(names);
    const std::size_t first = recording.sensors.size();
    int clock = 0;
    for (const InsLogger& logger : recording.loggers) clock = std::max(clock, logger.shared_clock + 1);
    std::size_t next = 0;
    std::int64_t start = std::numeric_limits<std::int64_t>::max();
    for (auto& [index, imu] : imus_) {
      sort_by_time(imu);
      start = std::min(start, imu.rows.front().time);
    }
    for (auto& [index, imu] : imus_) {
      recording.loggers.push_back(
          {.name = file_ + " " + imu.topic, .time = {}, .shared_clock = clock, .states_unit = true});
      recording.sensors.push_back(make_sensor(imu, start, recording.loggers.back()));
      recording.sensors.back().name = names[next++];
      recording.sensors.back().logger = recording.loggers.size() - 1;
    }
    for (auto& [index, magnetic] : magnetics_) add_field(magnetic, start, recording, first);
    recording.remarks.insert(recording.remarks.end(), remarks_.begin(), remarks_.end());
    return first;
  }

 private:
  /// Topics of write_ins_mcap, whose frames are the names of the sensors.
  bool is_written_by_kinfer() const {
    return std::ranges::all_of(imus_, [](const auto& imu) { return imu.second.topic == ins_topic(imu.second.frame); });
  }

  std::vector<std::string> frames() const {
    std::vector<std::string> names;
    for (const auto& [index, imu] : imus_) names.push_back(imu.frame);
    return names;
  }

  bool is_asked(const std::string& topic) const {
    return asked_.empty() || std::ranges::find(asked_, topic) != asked_.end();
  }

  static std::string list_of(const MessageLog& log) {
    std::string text;
    for (const LoggedTopic& topic : log.topics)
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", topic.name, topic.type);
    return text.empty() ? "none" : text;
  }

  Result<bool> add_topic(std::size_t index, const LoggedTopic& topic) {
    if (topic.type == "sensor_msgs/Imu" && is_asked(topic.name)) {
      KINFER_TRY(decoder, MessageDecoder::make(topic, imu_fields));
      imus_.emplace(index, ImuTopic{.topic = topic.name, .decoder = std::move(decoder)});
      return true;
    }
    if (topic.type == "sensor_msgs/MagneticField") {
      KINFER_TRY(decoder, MessageDecoder::make(topic, magnetic_fields));
      magnetics_.emplace(index, MagneticTopic{.topic = topic.name, .decoder = std::move(decoder)});
      return true;
    }
    return false;
  }

  Result<void> add_message(const LoggedMessage& message) {
    if (const auto imu = imus_.find(message.topic); imu != imus_.end()) {
      if (!decode(message, imu->second)) return misfit(imu->second.topic);
      imu->second.rows.push_back(
          {time_of(message), triad_of(fields_, 5, 1.0, &fields_[9]), triad_of(fields_, 2, 1.0, &fields_[8])});
    } else if (const auto magnetic = magnetics_.find(message.topic); magnetic != magnetics_.end()) {
      if (!decode(message, magnetic->second)) return misfit(magnetic->second.topic);
      magnetic->second.rows.push_back({time_of(message), triad_of(fields_, 2, microtesla, nullptr)});
    }
    return {};
  }

  template <class Row>
  bool decode(const LoggedMessage& message, TopicRows<Row>& topic) {
    if (!topic.decoder.decode(message.data, fields_)) return false;
    if (topic.rows.empty()) topic.frame = fields_[1].texts[0];
    return true;
  }

  Result<void> misfit(const std::string& topic) const {
    return error("{}: a message of topic {} is shorter than its type says, or not little-endian", file_, topic);
  }

  std::int64_t time_of(const LoggedMessage& message) const {
    const std::int64_t stamp = fields_[0].times[0];
    return stamp != 0 ? stamp : message.log_time;
  }

  /// Messages may arrive in another order than they were measured; of several with one time the first counts.
  template <class Row>
  void sort_by_time(TopicRows<Row>& topic) {
    std::ranges::stable_sort(topic.rows, {}, &Row::time);
    const auto begin =
        std::unique(topic.rows.begin(), topic.rows.end(), [](const Row& a, const Row& b) { return a.time == b.time; });
    const auto end = topic.rows.end();
    if (begin == end) return;
    remarks_.push_back(fmt::format("{}: topic {}: {} messages repeat the time of another and are not used", file_,
                                   topic.topic, std::distance(begin, end)));
    topic.rows.erase(begin, end);
  }

  static double seconds_since(std::int64_t start, std::int64_t time) {
    return 1e-9 * static_cast<double>(time - start);
  }

  static InsSensor make_sensor(const ImuTopic& imu, std::int64_t start, InsLogger& logger) {
    InsSensor sensor;
    for (std::size_t k = 0; k < 3; ++k)
      for (const ImuRow& row : imu.rows) {
        sensor.acceleration.axis[k].push_back(row.acceleration[k]);
        sensor.angular_velocity.axis[k].push_back(row.angular_velocity[k]);
      }
    for (const ImuRow& row : imu.rows) logger.time.push_back(seconds_since(start, row.time));
    return sensor;
  }

  /// The sensor that a field was measured by: of the same frame, else the one whose topic begins alike for longest.
  std::optional<std::size_t> sensor_of(const MagneticTopic& magnetic) const {
    std::vector<std::size_t> shared;
    std::vector<std::size_t> of_frame;
    std::size_t k = 0;
    for (const auto& [index, imu] : imus_) {
      const auto ends = std::ranges::mismatch(imu.topic, magnetic.topic);
      const std::string common(imu.topic.begin(), ends.in1);
      shared.push_back(static_cast<std::size_t>(std::ranges::count(common, '/')));
      if (!magnetic.frame.empty() && imu.frame == magnetic.frame) of_frame.push_back(k);
      ++k;
    }
    if (of_frame.size() == 1) return of_frame.front();
    const auto most = std::ranges::max_element(shared);
    if (std::ranges::count(shared, *most) > 1) return std::nullopt;
    return static_cast<std::size_t>(most - shared.begin());
  }

  /// Each row of the field goes to the sensor's row that is nearest in time, within half a period.
  void add_field(MagneticTopic& magnetic, std::int64_t start, InsRecording& recording, std::size_t first) {
    if (magnetic.rows.empty()) return;
    sort_by_time(magnetic);
    const auto which = sensor_of(magnetic);
    if (!which) {
      if (asked_.empty() || is_asked(magnetic.topic))
        remarks_.push_back(fmt::format("{}: topic {} belongs to no Imu topic by frame or name and is not used", file_,
                                       magnetic.topic));
      return;
    }
    InsSensor& sensor = recording.sensors[first + *which];
    const std::vector<double>& time = recording.loggers[sensor.logger].time;
    for (auto& axis : sensor.field.axis) axis.assign(time.size(), not_measured);
    const double reach = 0.5 * median_period(time);
    for (const MagneticRow& row : magnetic.rows) {
      const double at = seconds_since(start, row.time);
      auto nearest = static_cast<std::size_t>(std::ranges::lower_bound(time, at) - time.begin());
      if (nearest == time.size() || (nearest > 0 && at - time[nearest - 1] < time[nearest] - at)) --nearest;
      if (std::abs(time[nearest] - at) > reach) continue;
      for (std::size_t k = 0; k < 3; ++k) sensor.field.axis[k][nearest] = row.field[k];
    }
  }

  std::string file_;
  std::span<const std::string> asked_;
  std::map<std::size_t, ImuTopic> imus_;
  std::map<std::size_t, MagneticTopic> magnetics_;
  std::vector<DecodedField> fields_;
  std::vector<std::string> remarks_;
};

std::vector<std::string> parts_of(const std::string& topic) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < topic.size();) {
    const std::size_t end = std::min(topic.find('/', at), topic.size());
    if (end > at) parts.push_back(topic.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

}  // namespace

std::string ins_topic(const std::string& sensor) {
  return "/" + sensor + "/imu";
}

std::vector<std::string> short_topic_names(std::span<const std::string> topics) {
  std::map<std::string, std::size_t> uses;
  for (const std::string& topic : topics) {
    std::vector<std::string> parts = parts_of(topic);
    std::ranges::sort(parts);
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    for (const std::string& part : parts) ++uses[part];
  }
  constexpr std::array<std::string_view, 5> driver_words{"imu", "data", "data_raw", "raw", "sensors"};
  std::vector<std::string> names;
  for (const std::string& topic : topics) {
    std::string name;
    for (const std::string& part : parts_of(topic)) {
      const bool tells =
          topics.size() > 1 ? uses[part] < topics.size() : std::ranges::find(driver_words, part) == driver_words.end();
      if (tells) name += (name.empty() ? "" : "_") + part;
    }
    names.push_back(name.empty() ? "imu" : name);
  }
  return names;
}

Result<void> append_ins_topics(const std::filesystem::path& path, std::span<const std::string> topics,
                               InsRecording& recording, const Observer& observer) {
  InsTopicReader reader(path.string(), topics);
  if (auto done = reader.read(path, observer); !done) return done;
  const std::size_t first = reader.append(recording);
  for (std::size_t logger = recording.sensors[first].logger; logger < recording.loggers.size(); ++logger)
    add_time_remarks(recording, logger, recording.loggers[logger].name);
  return screen_sensors(recording, first, path.string(),
                        std::vector<std::array<bool, 3>>(recording.sensors.size() - first, {true, true, true}));
}

Result<void> append_all_ins_topics(const std::filesystem::path& path, InsRecording& recording,
                                   const Observer& observer) {
  return append_ins_topics(path, {}, recording, observer);
}

}  // namespace kinfer
