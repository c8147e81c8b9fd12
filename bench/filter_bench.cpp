// SPDX-License-Identifier: Apache-2.0
// Time of the orientation filters per row and sensor, and of reading a recording.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "kinfer/inertial/filters/orientation.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "support/carried_sensor.hpp"

namespace {

using namespace kinfer;

const testing::CarriedSensor& carried_sensor(double sampling_rate) {
  static const SensorModel grade = *sensor_grade("industrial");
  static const testing::CarriedSensor at200 =
      testing::carried({.seconds = 120.0, .sampling_rate = 200.0, .grade = &grade});
  static const testing::CarriedSensor at1000 =
      testing::carried({.seconds = 60.0, .sampling_rate = 1000.0, .grade = &grade});
  return sampling_rate > 500.0 ? at1000 : at200;
}

void filter_a_row(benchmark::State& state, const FilterOptions& options) {
  const testing::CarriedSensor& c = carried_sensor(static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(estimate_orientations(c.sensor, c.time, options));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(c.time.size()));
}

/// Every filter, with and without magnetometer.
const bool filters_are_registered = [] {
  for (const OrientationFilter& filter : orientation_filters()) {
    const std::string name = fmt::format("filter_a_row/{}", filter.name);
    benchmark::RegisterBenchmark(name.c_str(), filter_a_row, filter.default_options)->Arg(200)->Arg(1000);
    benchmark::RegisterBenchmark((name + "/without_magnetometer").c_str(), filter_a_row,
                                 without_magnetometer(filter.default_options))
        ->Arg(200);
  }
  return true;
}();

/// Six sensors with nine columns each, 60 MB.
void read_recording(benchmark::State& state) {
  const auto path = std::filesystem::temp_directory_path() / "kinfer_filter_bench.csv";
  {
    const testing::CarriedSensor& c = carried_sensor(200.0);
    std::ofstream file(path);
    file << "t";
    for (int sensor = 0; sensor < 6; ++sensor)
      for (const char* column : {"ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz"})
        file << ",ins" << sensor << '_' << column;
    file << '\n';
    for (std::size_t row = 0; file.tellp() < 60'000'000; ++row) {
      file << fmt::format("{:.4f}", 0.005 * static_cast<double>(row));
      const std::size_t at = row % c.time.size();
      for (int sensor = 0; sensor < 6; ++sensor)
        for (const TriadColumns* triad : {&c.sensor.acceleration, &c.sensor.angular_velocity, &c.sensor.field})
          for (const auto& axis : triad->axis) file << fmt::format(",{:.6g}", axis[at]);
      file << '\n';
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(read_ins_csv(path));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  std::filesystem::remove(path);
}
BENCHMARK(read_recording)->Unit(benchmark::kMillisecond);

}  // namespace
