// SPDX-License-Identifier: Apache-2.0
// Time of tracking per row of six sensors, scale matrices and considered geometry included.
#include <benchmark/benchmark.h>

#include "kinfer/track/tracker.hpp"
#include "support/tracked_machine.hpp"

namespace {

using namespace kinfer;

struct RowsOfADrive {
  TrackingModel model;
  std::vector<InsRow> rows;
};

const RowsOfADrive& excavator_rows() {
  static const RowsOfADrive made = [] {
    const test::SimulatedDrive drive = test::simulated_drive({.duration = 60.0});
    RowsOfADrive r{test::tracking_model_of(drive.machine, *sensor_grade("industrial"), 200.0), {}};
    r.rows.resize(drive.recording.loggers.front().time.size());
    for (std::size_t row = 0; row < r.rows.size(); ++row) test::fill_row(drive.recording, row, r.rows[row]);
    return r;
  }();
  return made;
}

/// The chain's filter with composed filters, fault monitor and read-out beside it.
void track_a_row(benchmark::State& state) {
  const RowsOfADrive& given = excavator_rows();
  for (auto _ : state) {
    track::Tracker tracker(given.model);
    for (const InsRow& row : given.rows) tracker.add(row);
    benchmark::DoNotOptimize(tracker.state().q.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(given.rows.size()));
}
BENCHMARK(track_a_row)->Unit(benchmark::kMillisecond);

/// The composed filters alone.
void compose_a_row(benchmark::State& state) {
  const RowsOfADrive& given = excavator_rows();
  for (auto _ : state) {
    track::ComposedFilters filters(given.model);
    for (const InsRow& row : given.rows) filters.add(row);
    benchmark::DoNotOptimize(filters.state().q.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(given.rows.size()));
}
BENCHMARK(compose_a_row)->Unit(benchmark::kMillisecond);

}  // namespace
