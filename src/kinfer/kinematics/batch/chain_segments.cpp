// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/batch/chain_segments.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "kinfer/base/expect.hpp"

namespace kinfer::batch {
namespace {

using elementary::Motion;

Factor rotation_factor(const Mat3& rotation) {
  Factor factor{.kind = Factor::Kind::constant_rotation, .axis = 0, .value = {}, .rotation = {}};
  for (int i = 0; i < 9; ++i) factor.rotation[i] = rotation(i / 3, i % 3);
  return factor;
}

/// Collects the factors between consecutive joint motions.
struct FactorCollector {
  std::vector<std::vector<Factor>> lists{{}};

  FactorCollector() { lists.back().reserve(usual); }

  void rotate(const Mat3& rotation) { lists.back().push_back(rotation_factor(rotation)); }
  void move(const elementary::Factor& factor, const Value& value, int) {
    const auto kind = factor.motion == Motion::rotation ? Factor::Kind::axis_rotation : Factor::Kind::axis_translation;
    if (value.parameter >= 0 || value.constant != 0.0)
      lists.back().push_back({.kind = kind, .axis = factor.axis, .value = value, .rotation = {}});
    if (!factor.moves) return;
    KINFER_EXPECT(factor.axis == 2, "every convention moves about or along z");
    lists.emplace_back().reserve(usual);
  }

 private:
  static constexpr std::size_t usual = 6;  // factors between two joints
};

Pose product(const std::vector<Factor>& factors) {
  Pose pose;
  for (const Factor& f : factors) {
    if (f.kind == Factor::Kind::constant_rotation) {
      pose.rotation *= Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(f.rotation);
    } else {
      elementary::apply(pose, f.kind == Factor::Kind::axis_rotation ? Motion::rotation : Motion::translation, f.axis,
                        f.value.constant);
    }
  }
  return pose;
}

/// TransZ(d) TransX(a) RotX(alpha) RotZ(theta), each at most once; what commutes may come in any order.
bool parse_link(const std::vector<Factor>& factors, Segment& segment) {
  using enum Factor::Kind;
  int stage = 0;  // 0: before alpha, 1: after alpha, 2: after theta
  bool has_a = false, has_d = false;
  for (const Factor& f : factors) {
    if (f.kind == axis_translation && f.axis == 2 && stage == 0 && !has_d) {
      segment.d = f.value, has_d = true;
    } else if (f.kind == axis_translation && f.axis == 0 && stage <= 1 && !has_a) {
      segment.a = f.value, has_a = true;
    } else if (f.kind == axis_rotation && f.axis == 0 && stage == 0) {
      segment.alpha = f.value, stage = 1;
    } else if (f.kind == axis_rotation && f.axis == 2 && stage <= 1) {
      segment.theta = f.value, stage = 2;
    } else {
      return false;
    }
  }
  return true;
}

Segment segment_of(const std::vector<Factor>& factors) {
  Segment segment;
  segment.varies = std::any_of(factors.begin(), factors.end(), [](const Factor& f) { return f.value.parameter >= 0; });
  if (factors.empty()) return segment;
  segment.shape = Shape::general;
  segment.factors = factors.data(), segment.factor_count = static_cast<int>(factors.size());
  if (segment.varies) {
    if (parse_link(factors, segment)) segment.shape = Shape::link;
    return segment;
  }
  const Pose pose = product(factors);
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) segment.numbers[4 * row + col] = pose.rotation(row, col);
    segment.numbers[4 * row + 3] = pose.position[row];
  }
  if (segment.numbers[2] == 0.0 && segment.numbers[7] == 0.0) segment.shape = Shape::link;
  return segment;
}

void put(const Value& value, int place, SheetColumn& column) {
  constexpr auto all_bits = ~std::uint64_t{0};
  column.constant[place] = value.constant, column.cos[place] = value.cos, column.sin[place] = value.sin;
  if (value.parameter < 0) return;
  column.parameter[place] = value.parameter;
  column.is_free[place] = std::bit_cast<double>(all_bits);
}

/// Puts the links that vary into sheets.
void fill_sheets(SegmentList& list) {
  std::vector<LinkSheet> sheets((list.segments.size() + links_per_sheet - 1) / links_per_sheet);
  for (std::size_t k = 0; k < list.segments.size(); ++k) {
    Segment& segment = list.segments[k];
    segment.in_sheet = segment.varies && segment.shape == Shape::link;
    list.is_all_in_sheets &= segment.in_sheet || !segment.varies;
    if (!segment.in_sheet) continue;
    LinkSheet& sheet = sheets[k / links_per_sheet];
    const auto place = static_cast<int>(k % links_per_sheet);
    put(segment.d, place, sheet.d), put(segment.a, place, sheet.a);
    put(segment.alpha, place, sheet.alpha), put(segment.theta, place, sheet.theta);
  }
  const auto in_sheet = [](const Segment& segment) { return segment.in_sheet; };
  if (std::any_of(list.segments.begin(), list.segments.end(), in_sheet)) list.sheets = std::move(sheets);
}

}  // namespace

SegmentList segments_of(const Chain& nominal, const ParameterSet& set, const ParameterLookup& lookup,
                        const std::vector<JointMotion>& joint_motions, BaseSide side) {
  SegmentList list;
  list.nominal = pack(set, nominal);
  list.angles = lookup.angles();
  FactorCollector collector;
  if (side == BaseSide::measurement && !lookup.frees_base()) {
    list.base = nominal.base.pose();
  } else {
    walk(nominal.base, SetupFrame::base, lookup, collector);
  }
  walk_joints_and_tool(nominal, lookup, collector);
  list.factors = std::move(collector.lists);
  for (const auto& factors : list.factors) list.segments.push_back(segment_of(factors));
  for (std::size_t k = 0; k < joint_motions.size(); ++k) {
    list.segments[k].move = joint_motions[k].move;
    list.segments[k].gain = joint_motions[k].gain;
    list.segments[k].slots_before = joint_motions[k].slot;
  }
  fill_sheets(list);
  return list;
}

}  // namespace kinfer::batch
