// SPDX-License-Identifier: Apache-2.0
#include "studies/track/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "kinfer/identify/pipeline.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/measurement/ins/ins_selection.hpp"
#include "kinfer/track/tracker.hpp"
#include "studies/support/optical_truth.hpp"
#include "studies/track/pairwise.hpp"
#include "studies/track/relative_orientation.hpp"

namespace kinfer::study::track_study {
namespace {

using Index = Eigen::Index;

/// A log to track, the one that its chain is identified from, and the reference between pairs of sensors.
struct MeasuredLog {
  std::string name;
  InsRecording identified, tracked;
  struct Pair {
    std::string parent, child;
    RelativeOrientation reference;
  };
  std::vector<Pair> pairs;
};

std::vector<std::vector<double>> read_numbers(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::stringstream stream(line);
    std::vector<double>& row = rows.emplace_back();
    for (std::string cell; std::getline(stream, cell, ',');)
      row.push_back(cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

/// The joints between two sensors, and whether their rotations are inverted: from the parent up to a common body and
/// down to the child.
struct RotationPath {
  struct Step {
    std::size_t joint = 0;
    bool is_inverse = false;
  };
  std::vector<Step> steps;
};

/// Joints from a sensor's body down to the base.
std::vector<std::size_t> joints_to_base(const TrackingModel& model, const std::string& sensor) {
  std::vector<std::size_t> joints;
  const auto found = std::ranges::find(model.sensors, sensor, &TrackingSensor::name);
  for (int b = found->body; b > 0;) {
    const TrackingBody& body = model.bodies[static_cast<std::size_t>(b)];
    const auto joint = static_cast<std::size_t>(body.joint);
    if (joints.empty() || joints.back() != joint) joints.push_back(joint);
    b = body.parent;
  }
  return joints;
}

RotationPath rotation_path(const TrackingModel& model, const MeasuredLog::Pair& pair) {
  std::vector<std::size_t> up = joints_to_base(model, pair.parent), down = joints_to_base(model, pair.child);
  while (!up.empty() && !down.empty() && up.back() == down.back()) up.pop_back(), down.pop_back();
  RotationPath path;
  for (const std::size_t joint : up) path.steps.push_back({joint, true});
  for (auto joint = down.rbegin(); joint != down.rend(); ++joint) path.steps.push_back({*joint, false});
  return path;
}

Mat3 rotation_along(const RotationPath& path, const TrackState& state) {
  Quat rotation = Quat::Identity();
  for (const RotationPath::Step& step : path.steps) {
    const Quat& own = state.joints[step.joint].parent_q_child;
    rotation = rotation * (step.is_inverse ? own.conjugate() : own);
  }
  return rotation.toRotationMatrix();
}

/// By pairwise filters, which know no other joints.
Mat3 rotation_along(const RotationPath& path, const PairwiseFilters& filters) {
  Mat3 rotation = Mat3::Identity();
  for (const RotationPath::Step& step : path.steps) {
    const Mat3 own = filters.rotation(step.joint);
    rotation = Mat3(rotation * (step.is_inverse ? Mat3(own.transpose()) : own));
  }
  return rotation;
}

struct TrackedLog {
  std::vector<RelativeOrientation> chain, composed, pairwise;
  std::vector<std::string> alarms;
};

TrackedLog tracked(const TrackingModel& model, const MeasuredLog& log) {
  TrackedLog result;
  result.chain.resize(log.pairs.size());
  result.composed.resize(log.pairs.size());
  result.pairwise.resize(log.pairs.size());
  kinfer::track::Tracker tracker(model, {});
  kinfer::track::ComposedFilters composed(model, {});
  PairwiseFilters pairwise(model);
  std::vector<RotationPath> paths;
  for (const MeasuredLog::Pair& pair : log.pairs) paths.push_back(rotation_path(model, pair));
  std::vector<const InsSensor*> sensors;
  for (const TrackingSensor& sensor : model.sensors)
    sensors.push_back(&*std::ranges::find(log.tracked.sensors, sensor.name, &InsSensor::name));
  InsRow row;
  row.sensors.resize(sensors.size());
  const std::vector<double>& time = log.tracked.loggers.front().time;
  for (std::size_t r = 0; r < time.size(); ++r) {
    row.time = time[r];
    for (std::size_t s = 0; s < sensors.size(); ++s)
      row.sensors[s] = sample(*sensors[s], log.tracked.time(*sensors[s]), r);
    tracker.add(row);
    composed.add(row);
    pairwise.add(row);
    if (!tracker.state().started) continue;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      result.chain[i].time.push_back(row.time);
      result.chain[i].rotation.push_back(rotation_along(paths[i], tracker.state()));
      result.composed[i].time.push_back(row.time);
      result.composed[i].rotation.push_back(rotation_along(paths[i], composed.state()));
      if (r == 0) continue;
      result.pairwise[i].time.push_back(time[r - 1]);
      result.pairwise[i].rotation.push_back(rotation_along(paths[i], pairwise));
    }
    for (const TrackAlarm& alarm : tracker.state().alarms) {
      const std::string text = fmt::format("{} {}", kinfer::name(alarm.kind), std::max(alarm.sensor, alarm.joint));
      if (std::ranges::find_if(result.alarms, [&](const auto& a) { return a.starts_with(text); }) ==
          result.alarms.end())
        result.alarms.push_back(fmt::format("{} at {:.1f}", text, row.time));
    }
  }
  return result;
}

void track(const MeasuredLog& log) {
  const auto found = identify::identify_machine(log.identified, {}, Rng(1));
  if (!found || !found->tracking) {
    fmt::print("{:<28} {}\n", log.name, found ? "no tracking model" : found.error().what);
    return;
  }
  const TrackedLog result = tracked(*found->tracking, log);
  const auto& time = log.tracked.loggers.front().time;
  constexpr double degree = std::numbers::pi / 180.0, settled = 2.0;  // [s]
  fmt::print("{:<28}", log.name);
  for (std::size_t i = 0; i < log.pairs.size(); ++i) {
    const auto rms = [&](const RelativeOrientation& estimate) {
      return rms_difference(estimate, log.pairs[i].reference, time.front() + settled, time.back()) / degree;
    };
    fmt::print("  {}-{} {:.2f} ({:.2f}, {:.2f})", log.pairs[i].parent, log.pairs[i].child, rms(result.chain[i]),
               rms(result.composed[i]), rms(result.pairwise[i]));
  }
  for (const std::string& alarm : result.alarms) fmt::print("; {}", alarm);
  fmt::print("\n");
  std::fflush(stdout);
}

/// Identified on one half of the log and tracked on the other.
void track_hand_moved_chain(const std::string& folder, const std::string& mounts) {
  const auto recording = read_ins_csv(folder + "/" + mounts + ".csv");
  const std::vector<std::string> segments{"seg1", "seg2", "seg3", "seg4", "seg5"};
  const auto optical = read_optical(folder + "/optical.csv", segments);
  if (!recording || !optical) return;
  const OpticalAlignment alignment = aligned(*optical, *recording);
  std::vector<MeasuredLog::Pair> pairs;
  for (std::size_t s = 0; s + 1 < segments.size(); ++s) {
    MeasuredLog::Pair pair{segments[s], segments[s + 1], {}};
    for (std::size_t i = 0; i < optical->time.size(); ++i) {
      pair.reference.time.push_back(optical->time[i] + alignment.late);
      pair.reference.rotation.emplace_back(optical->segment.at(segments[s])[i].transpose() *
                                           optical->segment.at(segments[s + 1])[i]);
    }
    pairs.push_back(std::move(pair));
  }
  const auto& time = recording->loggers.front().time;
  const double middle = 0.5 * (time.front() + time.back());
  const InsRecording first = within(*recording, time.front(), middle), second = within(*recording, middle, time.back());
  track({"DIODEM " + mounts + ", 2nd half", first, second, pairs});
  track({"DIODEM " + mounts + ", 1st half", second, first, pairs});
}

/// Sensors are named by letters; link 1 to 6 are D, A, F, B, E, C, and encoder k+1 is between links k and k+1.
void track_seven_axes(const std::string& folder, const std::string& trial) {
  const auto recording = read_ins_csv(folder + "/" + trial + "_imu.csv");
  const auto encoders = read_numbers(folder + "/" + trial + "_encoders.csv");
  if (!recording || encoders.empty()) return;
  const std::vector<std::string> link{"D", "A", "F", "B", "E", "C"};
  const auto sensor_of = [&](const std::string& letter) {
    for (const InsSensor& sensor : recording->sensors)
      if (sensor.name.ends_with(letter)) return sensor.name;
    return letter;
  };
  MeasuredLog log{"KUKA iiwa " + trial, *recording, *recording, {}};
  for (std::size_t k = 0; k + 1 < link.size(); ++k) {
    MeasuredLog::Pair pair{sensor_of(link[k]), sensor_of(link[k + 1]), {}};
    for (const auto& row : encoders) {
      pair.reference.time.push_back(row[0]);
      pair.reference.rotation.push_back(rot_z(row[k + 2]));
    }
    log.pairs.push_back(std::move(pair));
  }
  track(log);
}

Mat3 rotation_at(const std::vector<double>& row, std::size_t first) {
  return Quat(row[first], row[first + 1], row[first + 2], row[first + 3]).normalized().toRotationMatrix();
}

void track_forearm(const std::string& folder, const std::string& run) {
  const auto recording = read_ins_csv(folder + "/" + run + "_imu.csv");
  const auto truth = read_numbers(folder + "/" + run + "_truth.csv");
  if (!recording || truth.empty()) return;
  MeasuredLog log{"UR5 " + run, *recording, *recording, {{"radius", "carpus", {}}}};
  for (const auto& row : truth) {
    log.pairs[0].reference.time.push_back(row[0]);
    log.pairs[0].reference.rotation.emplace_back(rotation_at(row, 5).transpose() * rotation_at(row, 9));
  }
  track(log);
}

}  // namespace

void track_measured(const std::string& folder, const std::string& only) {
  if (folder.empty() || !std::filesystem::exists(folder)) {
    fmt::print("measured chains are skipped: KINFER_DATA does not name a folder\n");
    return;
  }
  fmt::print(
      "pair of sensors: rms angle between relative orientations [deg] (composed filters, Weygers and Kok 2020)\n");
  const auto wanted = [&](const char* name) { return only.empty() || only == name; };
  if (wanted("diodem"))
    for (const char* mounts : {"rigid", "nonrigid"}) track_hand_moved_chain(folder + "/diodem_chain5/trial1", mounts);
  if (wanted("rigid")) track_hand_moved_chain(folder + "/diodem_chain5/trial1", "rigid");
  if (wanted("kuka"))
    for (const char* trial : {"trial1", "trial3"}) track_seven_axes(folder + "/kuka_iiwa_ins", trial);
  if (wanted("ur5"))
    for (const char* run : {"circle-150", "circle-250", "triangle-150"}) track_forearm(folder + "/ur5_openaxes", run);
}

}  // namespace kinfer::study::track_study
