// SPDX-License-Identifier: Apache-2.0
// The library is the program: the same files give the same evidence, byte for byte.
#include "cli/program.hpp"
#include "kinfer/base/sha256.hpp"
#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/start/local_poe.hpp"
#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer::test {
namespace {

class CalibrateLibrary : public Program {
 protected:
  /// Evidence of the library for the files in data/.
  std::string evidence(calibrate::CalibrationTask task, const calibrate::CalibrationOptions& options,
                       const std::vector<std::string>& files) const {
    task.data = read_pose_set(in("data/poses.csv"), task.nominal, {}).value();
    Provenance provenance{.inputs = {}, .options = calibrate::describe(task, options)};
    for (const std::string& file : files) provenance.inputs.push_back({file, *sha256_of_file(in("data") / file)});
    return format_calibration_evidence(
        calibration_evidence(calibrate::calibrate_robot(task, options, Rng(1)).value(), provenance));
  }
};

TEST_F(CalibrateLibrary, EvidenceOfARobotFileIsThatOfTheProgram) {
  simulate();
  ASSERT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out cal").code, 0);
  const RobotModel robot = read_robot_toml(in("data/robot.toml")).value();
  EXPECT_EQ(evidence({.nominal = robot.chain, .tolerances = robot.tolerances, .instrument = robot.instrument}, {},
                     {"robot.toml", "poses.csv"}),
            slurp(in("cal/evidence.json")));
}

TEST_F(CalibrateLibrary, EvidenceOfJointTypesAloneIsThatOfTheProgram) {
  simulate();
  ASSERT_LT(kinfer("calibrate --robot unknown:6R --data data/poses.csv --holdout 0.2 --out cal").code, 2);
  const std::vector<JointType> types = calibrate::parse_joint_types("6R").value();
  EXPECT_EQ(evidence({.nominal = calibrate::make_serial_chain(types), .joint_types = types},
                     {.holdout = calibrate::HeldOutFraction{0.2}}, {"poses.csv"}),
            slurp(in("cal/evidence.json")));
}

/// Options that would have no effect are refused in one sentence, before anything is computed.
struct Refused {
  std::string name, options, words;
};
void PrintTo(const Refused& refused, std::ostream* out) {
  *out << refused.name;
}

class OptionsWithoutEffect : public Program, public ::testing::WithParamInterface<Refused> {};

TEST_P(OptionsWithoutEffect, AreRefused) {
  const Outcome run = kinfer("calibrate --robot robot.toml --data poses.csv --out cal " + GetParam().options);
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(GetParam().words), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(in("cal")));
}

INSTANTIATE_TEST_SUITE_P(
    all, OptionsWithoutEffect,
    ::testing::Values(
        Refused{"particles_of_lm", "--particles 50", "--particles has no effect with --method lm"},
        Refused{"inertia_of_qpso", "--method qpso --inertia 0.7", "--inertia has no effect with --method qpso"},
        Refused{"net_use_of_pso", "--method pso --net-use every-update", "--net-use has no effect with --method pso"},
        Refused{"two_boxes", "--method pso --box-length 2 --box-tolerances 3", "--box-length has no effect"},
        Refused{"model_of_a_swarm", "--method pso --model geometry", "--model has no effect with --method pso"},
        Refused{"model_of_paper24", "--parameters paper24 --model gravity", "--model has no effect with --parameters"},
        Refused{"model_of_a_refit", "--refit offsets --warm-start cal0 --model auto", "--model has no effect"},
        Refused{"parameters_of_a_refit", "--refit offsets --warm-start cal0 --parameters auto",
                "--parameters has no effect"},
        Refused{"refit_without_earlier", "--refit offsets", "expected --warm-start DIR"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace kinfer::test
