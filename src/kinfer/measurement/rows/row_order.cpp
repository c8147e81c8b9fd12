// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/rows/row_order.hpp"

#include <algorithm>
#include <limits>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

/// Samples that `row` lacks, from another row of the same time.
void complete(InsRow& row, const InsRow& other) {
  KINFER_EXPECT(row.sensors.size() == other.sensors.size());
  for (std::size_t s = 0; s < row.sensors.size(); ++s) {
    const InsSample& theirs = other.sensors[s];
    InsSample& own = row.sensors[s];
    const bool is_empty = !own.has_acceleration && !own.has_angular_velocity && !own.has_field;
    if (is_empty) own = theirs;
  }
}

}  // namespace

Result<void> RowOrder::add(const InsRow& row, const InsRowSink& sink) {
  if (has_passed_ && row.time <= passed_) {
    ++dropped_;
    return {};
  }
  const auto place = std::ranges::lower_bound(waiting_, row.time, {}, &InsRow::time);
  if (place != waiting_.end() && place->time == row.time)
    complete(*place, row);
  else
    waiting_.insert(place, row);
  newest_ = has_rows_ ? std::max(newest_, row.time) : row.time;
  has_rows_ = true;
  return pass_until(newest_ - longest_delay_, sink);
}

Result<void> RowOrder::pass_until(double time, const InsRowSink& sink) {
  while (!waiting_.empty() && waiting_.front().time <= time) {
    passed_ = waiting_.front().time;
    has_passed_ = true;
    if (auto done = sink(waiting_.front()); !done) return done;
    waiting_.pop_front();
  }
  return {};
}

Result<void> RowOrder::finish(const InsRowSink& sink) {
  return pass_until(std::numeric_limits<double>::infinity(), sink);
}

}  // namespace kinfer
