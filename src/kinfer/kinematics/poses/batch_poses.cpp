// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/batch_poses.hpp"

#include <algorithm>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/poses/pose_plan.hpp"

namespace kinfer {
namespace {

/// The numbers of row `row` in an array of so many numbers x lanes a block.
class NumbersOfRow {
 public:
  NumbersOfRow(const double* blocks, std::size_t row, std::size_t lanes, std::size_t numbers)
      : from_(blocks + row / lanes * lanes * numbers + row % lanes), lanes_(lanes) {}
  void copy(std::size_t first, std::size_t count, double* to) const {
    for (std::size_t k = 0; k < count; ++k) to[k] = from_[(first + k) * lanes_];
  }

 private:
  const double* from_;
  std::size_t lanes_;
};

/// Where a job's numbers lie in the scratch.
struct Memory {
  double *items = nullptr, *poses = nullptr, *twists = nullptr, *workspace = nullptr;
};

}  // namespace

struct BatchPoses::Plan {
  Plan(const Chain& of, const ParameterSet& set, const batch::Kernels& by)
      : chain(of), kernels(by), plan(batch::pose_plan_of(of, set)) {
    const auto free = set.free();
    for (std::size_t c = 0; c < free.size(); ++c)
      if (plan.columns[c].rotates && is_own_frame_parameter(free[c]->at, SetupFrame::base))
        base_turns.push_back(static_cast<Eigen::Index>(c));
  }

  Chain chain;
  const batch::Kernels& kernels;
  batch::PosePlan plan;
  std::vector<Eigen::Index> base_turns;  // columns

  std::size_t lanes() const { return static_cast<std::size_t>(kernels.lanes); }

  void fill(const PoseRow& row, double* item) const {
    const batch::ItemLayout& at = plan.layout;
    const auto set = [&](int number, double value) { item[static_cast<std::size_t>(number) * lanes()] = value; };
    for (int k = 0; k < at.dof; ++k) {
      set(k, row.q[k]);
      if (at.torques >= 0) set(at.torques + k, value_or_zero(row.load.torques, k));
      if (at.approach >= 0) set(at.approach + k, value_or_zero(row.load.approach, k));
    }
    if (at.gravity >= 0) {
      for (int j = 0; j < static_cast<int>(plan.joints.size()); ++j)
        set(at.gravity + j, row.load.gravity.empty() ? 0.0 : row.load.gravity[j]);
    }
    if (at.payload >= 0) set(at.payload, row.load.payload);
    if (at.rise >= 0) set(at.rise, row.load.temperature_rise);
  }

  /// Lanes without a row repeat the last one, so that they compute with finite numbers.
  void fill(std::span<const PoseRow> rows, std::size_t blocks, double* items) const {
    for (std::size_t place = 0; place < blocks * lanes(); ++place)
      fill(rows[std::min(place, rows.size() - 1)],
           items + place / lanes() * lanes() * static_cast<std::size_t>(plan.layout.stride) + place % lanes());
  }

  batch::GravityPlan gravity_of(std::span<const PoseRow> rows) const {
    const auto is_given = [](const PoseRow& row) { return !row.load.gravity.empty(); };
    const auto has_payload = [](const PoseRow& row) { return row.load.payload != 0.0; };
    batch::GravityPlan gravity;
    if (plan.layout.gravity < 0) return gravity;
    if (is_given(rows.front())) {
      KINFER_EXPECT(std::ranges::all_of(rows, is_given), "gravity torques are given at some of {} rows", rows.size());
      return gravity;
    }
    if (chain.masses.empty() && std::ranges::none_of(rows, has_payload)) return gravity;
    gravity.joints = plan.loaded.data(), gravity.joint_count = static_cast<int>(plan.loaded.size());
    gravity.masses = plan.masses.data(), gravity.mass_count = static_cast<int>(plan.masses.size());
    batch::write_rows(chain.base.pose(), gravity.base);
    std::ranges::copy(chain.gravity, gravity.gravity);
    gravity.torques = plan.layout.gravity;
    return gravity;
  }

  batch::PoseJob job_of(std::span<const PoseRow> rows, std::size_t blocks, bool recorded, const Memory& memory) const {
    const std::vector<batch::PoseStep>& steps = recorded ? plan.recorded_steps : plan.pose_steps;
    batch::PoseJob job{.steps = steps.data(),
                       .step_count = static_cast<int>(steps.size()),
                       .constants = plan.constants.data(),
                       .terms = plan.terms.data(),
                       .joints = plan.joints.data(),
                       .waves = plan.waves.data(),
                       .wave_count = static_cast<int>(plan.waves.size()),
                       .gravity = gravity_of(rows),
                       .items = memory.items,
                       .stride = plan.layout.stride,
                       .blocks = static_cast<int>(blocks),
                       .expansion = chain.expansion,
                       .rise = plan.layout.rise,
                       .columns = plan.columns.data(),
                       .column_count = static_cast<int>(plan.columns.size()),
                       .poses = memory.poses,
                       .twists = recorded ? memory.twists : nullptr,
                       .workspace = memory.workspace};
    std::ranges::copy(chain.base.xyz, job.base);
    return job;
  }

  /// The displacement of the field, which turns with the base and with nothing else.
  void add_field(const PoseRow& row, const Mat3& base_rotation) const {
    const Eigen::Map<const VectorXd> q(row.q, plan.layout.dof);
    const Vec3 displacement = base_rotation * displacement_at(chain.field, q);
    row.pose->position += displacement;
    if (!row.twists) return;
    for (const Eigen::Index c : base_turns) {
      auto column = row.twists->col(c);
      column.head<3>() += Vec3(column.tail<3>()).cross(displacement);
    }
  }

  void evaluate(std::span<const PoseRow> rows, Scratch& scratch) const {
    if (rows.empty()) return;
    const bool recorded = rows.front().twists != nullptr;
    const std::size_t blocks = (rows.size() + lanes() - 1) / lanes(), all = blocks * lanes();
    const std::size_t twist_size = 6 * plan.columns.size();
    const std::size_t items = all * static_cast<std::size_t>(plan.layout.stride),
                      twists = recorded ? all * twist_size : 0;
    scratch.reserve(items + 12 * all + twists +
                    batch::pose_workspace(static_cast<int>(plan.loaded.size()), kernels.lanes));
    double* first = scratch.data();
    const Memory memory{first, first + items, first + items + 12 * all, first + items + 12 * all + twists};
    fill(rows, blocks, memory.items);
    kernels.poses(job_of(rows, blocks, recorded, memory));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const NumbersOfRow pose(memory.poses, i, lanes(), 12);
      pose.copy(0, 9, rows[i].pose->rotation.data());
      pose.copy(9, 3, rows[i].pose->position.data());
      if (!recorded) continue;
      rows[i].twists->resize(6, static_cast<Eigen::Index>(plan.columns.size()));
      NumbersOfRow(memory.twists, i, lanes(), twist_size).copy(0, twist_size, rows[i].twists->data());
    }
    if (chain.field.empty()) return;
    const Mat3 base_rotation = chain.base.pose().rotation;
    for (const PoseRow& row : rows) add_field(row, base_rotation);
  }
};

BatchPoses::BatchPoses(const Chain& chain, const ParameterSet& set, const batch::Kernels& kernels) {
  expect_well_formed(chain);
  plan_ = std::make_unique<const Plan>(chain, set, kernels);
}

BatchPoses::~BatchPoses() = default;
BatchPoses::BatchPoses(BatchPoses&&) noexcept = default;

void BatchPoses::evaluate(std::span<const PoseRow> rows, Scratch& scratch) const {
  plan_->evaluate(rows, scratch);
}

}  // namespace kinfer
