// SPDX-License-Identifier: Apache-2.0
// kinfer.plan and kinfer.compensate
#include <cmath>

#include "background.hpp"
#include "kinfer/deploy/compensate.hpp"
#include "kinfer/plan/plan_poses.hpp"
#include "robot.hpp"

namespace kinfer::python {
namespace {

py::dict plan_in_python(const Robot& robot, int poses_wanted, const std::string& measured, const std::string& criterion,
                        const std::optional<double>& sd, const std::optional<double>& sd_angle,
                        const py::object& candidates, const py::object& existing, std::uint64_t seed, int threads) {
  const Chain& chain = robot.model.chain;
  plan::PlanTask task{.nominal = chain};
  task.tolerances = robot.model.tolerances;
  if (robot.model.instrument) task.instrument = plan::planned_instrument(*robot.model.instrument);
  if (sd) task.instrument.sigma = *sd;
  if (sd_angle) task.instrument.sigma_angle = *sd_angle;
  if (measured != "position" && measured != "pose")
    throw InputError(fmt::format("measured: \"{}\": expected \"position\" or \"pose\"", measured));
  task.measures = measured == "pose" ? plan::Measures::poses : plan::Measures::positions;
  if (!candidates.is_none()) task.candidates = as_columns(joint_positions(candidates, chain, "candidates"));
  if (!existing.is_none()) {
    task.existing = existing.cast<Poses>().set;
    if (task.existing.joints.rows() != dof(chain)) throw InputError("existing: the pose set is of another robot");
  }
  const auto how = criterion_named(criterion);
  if (!how) throw InputError(fmt::format("criterion: \"{}\": expected tool, worst, d, a or e", criterion));
  if (poses_wanted < 1) throw InputError("poses: expected a number from 1");
  const plan::PlanOptions options{.poses = poses_wanted, .criterion = *how, .threads = threads};
  std::optional<Result<PosePlan>> result;
  Background(py::none()).run([&](const Observer&) { result = plan::plan_poses(task, options, Rng(seed)); });
  const PosePlan plan = value_of(std::move(*result));
  using namespace py::literals;
  return py::dict("joints"_a = array_of(plan.joints.transpose()), "expected_rms"_a = plan.expected.rms,
                  "expected_worst"_a = plan.expected.worst, "random_rms"_a = plan.random.rms, "rank"_a = plan.rank,
                  "parameters"_a = plan.parameters);
}

std::optional<deploy::CompensationFrames> frames_named(const std::string& name) {
  if (name == "world") return deploy::CompensationFrames::as_given;
  if (name == "robot") return deploy::CompensationFrames::robot;
  if (name == "auto") return std::nullopt;
  throw InputError(fmt::format("frames: \"{}\": expected auto, world or robot", name));
}

std::vector<deploy::ToolTarget> tool_targets(const py::object& targets) {
  std::vector<deploy::ToolTarget> list;
  if (numbers(targets, "targets").ndim() == 3) {
    for (const auto& pose : poses(targets, "targets")) {
      if (!pose) throw InputError("targets: a row is not finite");
      list.push_back({pose->position, pose->rotation});
    }
    return list;
  }
  const Numbers xyz = table(targets, "targets", 3);
  for (py::ssize_t i = 0; i < xyz.shape(0); ++i) {
    list.push_back({Vec3(xyz.data() + 3 * i), std::nullopt});
    if (!list.back().position.allFinite()) throw InputError(fmt::format("targets: row {} (from 0) is not finite", i));
  }
  return list;
}

py::dict compensate_in_python(const Robot& corrected, const Robot& nominal, const py::object& joints,
                              const py::object& targets, const std::string& frames, std::uint64_t seed, int threads) {
  if (joints.is_none() == targets.is_none()) throw InputError("expected either joints or targets");
  const auto models =
      value_of(deploy::prepare_compensation(corrected.model.chain, nominal.model.chain, nominal.model.tolerances,
                                            frames_named(frames), corrected.model.prediction));
  std::optional<Numbers> q;
  if (!joints.is_none()) q = joint_positions(joints, models.nominal);
  const auto wanted = q ? std::vector<deploy::ToolTarget>{} : tool_targets(targets);
  std::vector<CompensatedJoints> list;
  {
    const py::gil_scoped_release without_lock;
    list =
        q ? deploy::compensate_joints(models.corrected, models.nominal, as_columns(*q), threads, models.prediction)
          : deploy::compensate_targets(models.corrected, models.nominal, wanted, {}, threads, seed, models.prediction);
  }
  MatrixXd found(static_cast<Eigen::Index>(list.size()), dof(models.nominal)), residual(found.rows(), 1);
  py::list reached;
  for (Eigen::Index i = 0; i < found.rows(); ++i) {
    found.row(i) = list[i].q.transpose(), residual(i, 0) = list[i].residual;
    reached.append(list[i].status == InverseStatus::reached);
  }
  using namespace py::literals;
  return py::dict("joints"_a = array_of(found), "residual"_a = array_of(residual).attr("ravel")(),
                  "reached"_a = py::module_::import("numpy").attr("array")(reached, "dtype"_a = "bool"));
}

}  // namespace

void add_deployment(py::module_& module) {
  module.def(
      "plan", &plan_in_python, py::arg("robot"), py::arg("poses") = 20, py::kw_only(), py::arg("measured") = "position",
      py::arg("criterion") = "tool", py::arg("sd") = py::none(), py::arg("sd_angle") = py::none(),
      py::arg("candidates") = py::none(), py::arg("existing") = py::none(), py::arg("seed") = 1, py::arg("threads") = 0,
      "Which poses to measure. Returns joints (n, dof) [rad] or [m], ordered for short travel, expected_rms and "
      "expected_worst of the tool after the calibration [m], random_rms of as many random poses [m], and rank of "
      "the identifiable parameters. sd [m], sd_angle [rad]: accuracy of the instrument. candidates: (m, dof) to "
      "choose from. existing: PoseSet that is measured already.");
  module.def("compensate", &compensate_in_python, py::arg("corrected"), py::arg("nominal"),
             py::arg("joints") = py::none(), py::kw_only(), py::arg("targets") = py::none(), py::arg("frames") = "auto",
             py::arg("seed") = 1, py::arg("threads") = 0,
             "Joint positions that put the real tool where the nominal model has it at joints (n, dof), or at targets "
             "(n, 3) or (n, 4, 4) [m]. Returns joints (n, dof), residual (n,) [m] and reached (n,).");
}

}  // namespace kinfer::python
