// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/pose_program.hpp"

#include <algorithm>
#include <optional>

namespace kinfer::program {
namespace {

using elementary::Factor;
using elementary::Motion;

// Cost of a step in multiplications: a run of constant factors is merged into one transform where that is cheaper.
constexpr int turn_cost = 12, shift_cost = 3, transform_cost = 36;
constexpr int matrix_cost =
    transform_cost + 1;  // a constant rotation is not an elementary step: it always needs a transform

/// Constant factors since the last step that was written.
struct Pending {
  std::vector<Step> steps;
  Pose product;
  int cost = 0;
};

class Compiler {
 public:
  explicit Compiler(const std::vector<Column>& columns) : columns_(columns) {}

  void walk(const Frame& frame, SetupFrame which) {
    frame_ = which, joint_ = -1;
    elementary::for_each_factor(frame, *this);
  }

  void walk(const Joint& joint, int index) {
    joint_ = index;
    elementary::for_each_factor(joint, *this);
  }

  void operator()(const Mat3& rotation) {
    if (rotation == Mat3::Identity()) return;
    pending_.product.rotation *= rotation;
    pending_.cost += matrix_cost;
  }

  void operator()(const Factor& factor) {
    if (factor.field) record(factor, *factor.field, Scale::one);
    if (factor.moves) {
      record(factor, Field::gain, Scale::joint_position);
      record(factor, Field::compliance, Scale::torque);
      record(factor, Field::torque_compliance, Scale::measured_torque);
      record(factor, Field::backlash, Scale::approach);
      record(factor, Field::sine, Scale::sine);
      record(factor, Field::cosine, Scale::cosine);
      record(factor, Field::coupling, Scale::coupled);
      flush();
      const auto kind = factor.motion == Motion::rotation ? Step::Kind::revolute_joint : Step::Kind::prismatic_joint;
      list_.steps.push_back({.kind = kind, .axis = factor.axis, .index = joint_, .a = factor.value});
    } else if (factor.value != 0.0) {
      append(factor);
    }
  }

  void mark_flange() {
    flush();
    list_.steps.push_back({.kind = Step::Kind::flange});
  }

  StepList finish() {
    flush();
    return std::move(list_);
  }

 private:
  void append(const Factor& factor) {
    Step step{.axis = factor.axis};
    if (factor.motion == Motion::rotation) {
      step.kind = Step::Kind::rotate, step.a = std::cos(factor.value), step.b = std::sin(factor.value);
      pending_.cost += turn_cost;
    } else {
      step.kind = Step::Kind::translate, step.a = factor.value;
      pending_.cost += shift_cost;
    }
    pending_.steps.push_back(step);
    elementary::apply(pending_.product, factor.motion, factor.axis, factor.value);
  }

  /// The term of an address that is `field` of the frame or joint walked now; none: another number.
  std::optional<int> term_here(const ParameterAddress& at, Field field) const {
    if (const JointNumber* number = joint_number(at))
      return number->joint == joint_ && number->field == field ? std::optional(number->term) : std::nullopt;
    const bool is_here = joint_ < 0 && is_own_frame_parameter(at, frame_) && field_of(at) == field;
    return is_here ? std::optional(0) : std::nullopt;
  }

  void record(const Factor& factor, Field field, Scale scale) {
    for (const Column& column : columns_) {
      const std::optional<int> term = term_here(column.at, field);
      if (!term) continue;
      flush();
      list_.steps.push_back({.kind = Step::Kind::record,
                             .axis = factor.axis,
                             .index = column.index,
                             .scale = scale,
                             .source = joint_,
                             .term = *term,
                             .motion = factor.motion});
    }
  }

  void flush() {
    if (pending_.cost > transform_cost) {
      list_.steps.push_back({.kind = Step::Kind::transform, .index = static_cast<int>(list_.constants.size())});
      list_.constants.push_back(pending_.product);
    } else {
      list_.steps.insert(list_.steps.end(), pending_.steps.begin(), pending_.steps.end());
    }
    pending_ = {};
  }

  const std::vector<Column>& columns_;
  SetupFrame frame_ = SetupFrame::base;  // where no joint is walked
  int joint_ = -1;
  Pending pending_;
  StepList list_;
};

bool has_expansion(const Chain& chain, const std::vector<Column>& columns) {
  const auto is_expansion = [](const Column& column) { return std::holds_alternative<ExpansionNumber>(column.at); };
  return chain.expansion != 0.0 || std::any_of(columns.begin(), columns.end(), is_expansion);
}

}  // namespace

StepList compile(const Chain& chain, const std::vector<Column>& columns) {
  Compiler compiler(columns);
  compiler.walk(chain.base, SetupFrame::base);
  for (const int j : path_to(chain, chain.tip_joint())) compiler.walk(chain.joints[j], j);
  if (has_expansion(chain, columns)) compiler.mark_flange();
  compiler.walk(chain.tool, SetupFrame::tool);
  return compiler.finish();
}

}  // namespace kinfer::program
