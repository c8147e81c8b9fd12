// SPDX-License-Identifier: Apache-2.0
// Time to read robot logs and compressed text.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <zstd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/recording/ins_mcap.hpp"
#include "kinfer/io/recording/recording_formats.hpp"

namespace {

using namespace kinfer;

/// Sensors at rest with a little motion; values as instruments have them, which do not repeat.
InsRecording sample_recording(int sensors, int rows, double rate) {
  InsRecording recording;
  recording.loggers = {{.name = "log", .time = {}}};
  for (int row = 0; row < rows; ++row) recording.loggers[0].time.push_back(row / rate);
  for (int s = 0; s < sensors; ++s) {
    InsSensor sensor{
        .name = fmt::format("ins{}", s), .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
    for (std::size_t k = 0; k < 3; ++k)
      for (int row = 0; row < rows; ++row) {
        const double phase = 0.37 * row + 1.1 * static_cast<double>(k) + s;
        sensor.acceleration.axis[k].push_back(static_cast<float>((k == 2 ? 9.8 : 0.0) + 0.03 * std::sin(97.0 * phase)));
        sensor.angular_velocity.axis[k].push_back(
            static_cast<float>(0.3 * std::sin(0.01 * phase) + 0.002 * std::sin(89.0 * phase)));
      }
    sensor.faults.assign(static_cast<std::size_t>(rows), 0);
    recording.sensors.push_back(std::move(sensor));
  }
  return recording;
}

void read_mcap(benchmark::State& state, int sensors, int rows, double rate) {
  const auto path = std::filesystem::temp_directory_path() / "kinfer_robot_log_bench.mcap";
  if (!write_ins_mcap(path, sample_recording(sensors, rows, rate))) return state.SkipWithError("not written");
  for (auto _ : state) benchmark::DoNotOptimize(read_recording(std::span(&path, 1)));
  state.SetItemsProcessed(state.iterations() * sensors * rows);
  std::filesystem::remove(path);
}

/// 100 000 messages of sensor_msgs/Imu in zstd chunks.
void read_mcap_100000(benchmark::State& state) {
  read_mcap(state, 1, 100'000, 200.0);
}
BENCHMARK(read_mcap_100000)->Unit(benchmark::kMillisecond);

/// An hour of six sensors at 100 Hz: 2.16 million messages.
void read_mcap_hour_of_six(benchmark::State& state) {
  read_mcap(state, 6, 360'000, 100.0);
}
BENCHMARK(read_mcap_hour_of_six)->Unit(benchmark::kMillisecond)->Iterations(3);

/// Text of 30 MB, compressed by zstd; bytes are those of the text.
void read_zstd_csv(benchmark::State& state) {
  const auto path = std::filesystem::temp_directory_path() / "kinfer_robot_log_bench.csv.zst";
  const InsRecording recording = sample_recording(6, 90'000, 200.0);
  std::string text = "t";
  for (const InsSensor& sensor : recording.sensors)
    for (const char* column : {"ax", "ay", "az", "gx", "gy", "gz"}) text += fmt::format(",{}_{}", sensor.name, column);
  for (std::size_t row = 0; row < recording.loggers[0].time.size(); ++row) {
    text += fmt::format("\n{:.4f}", recording.loggers[0].time[row]);
    for (const InsSensor& sensor : recording.sensors)
      for (const TriadColumns* triad : {&sensor.acceleration, &sensor.angular_velocity})
        for (const auto& axis : triad->axis) text += fmt::format(",{:.6g}", axis[row]);
  }
  text += '\n';
  std::string packed(ZSTD_compressBound(text.size()), '\0');
  constexpr int level = 3;
  packed.resize(ZSTD_compress(packed.data(), packed.size(), text.data(), text.size(), level));
  std::ofstream(path, std::ios::binary) << packed;
  for (auto _ : state) benchmark::DoNotOptimize(read_ins_csv(path));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  std::filesystem::remove(path);
}
BENCHMARK(read_zstd_csv)->Unit(benchmark::kMillisecond);

}  // namespace
