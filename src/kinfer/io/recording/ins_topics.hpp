// SPDX-License-Identifier: Apache-2.0
// INS recordings out of robot logs: sensor_msgs/Imu and the sensor_msgs/MagneticField that belongs to it.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// Adds a sensor, with a logger of its own, for each Imu topic; `topics`: only these, all where empty. Time is that of
/// the message's header, in seconds since the first of the file; that of the log where headers have none. All sensors
/// share a clock. A sensor is named after the part of its topic that tells it from the others, and keeps its name where
/// kinfer wrote the file. A topic of MagneticField belongs to the Imu topic of the same frame, else to the one that
/// shares more of its name than any other.
/// Errors: no such topic, none that is an Imu, messages that do not fit their type.
Result<void> append_ins_topics(const std::filesystem::path& path, std::span<const std::string> topics,
                               InsRecording& recording, const Observer& observer = {});

/// The same with all topics.
Result<void> append_all_ins_topics(const std::filesystem::path& path, InsRecording& recording,
                                   const Observer& observer = {});

/// The Imu topic of a sensor in a file that kinfer writes; the sensor's name is its frame, too.
std::string ins_topic(const std::string& sensor);

/// "/boom/imu/data", "/arm/imu/data" → "boom", "arm": the parts that not all names share. One name alone: its first
/// part that is no usual word of a sensor driver.
std::vector<std::string> short_topic_names(std::span<const std::string> topics);

}  // namespace kinfer
