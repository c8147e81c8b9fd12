// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "kinfer/io/robot/model_formats.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

using test::slurp;
using test::write;
using testing::HasSubstr;

class Identify : public test::Program {
 protected:
  /// The excavator's log, short enough for a test; few generations of the search suffice.
  void simulate() {
    ASSERT_EQ(kinfer("simulate excavator --excitation together --out drive --grade noise --quiet").code, 0);
  }
};

TEST_F(Identify, WritesTheChainAndItsEvidenceAndTheSameBytesForAnyNumberOfThreads) {
  simulate();
  const std::string how = "identify drive/imu.csv --engine bp --generations 5 --individuals 20 --links 2 ";
  const auto one = kinfer(how + "--out one --threads 1");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("who moves when"));
  ASSERT_EQ(kinfer(how + "--out seven --threads 7 --quiet").code, 0);
  for (const char* name : {"chain.toml", "chain.urdf", "chain_dh.csv", "evidence.json"}) {
    EXPECT_FALSE(slurp(in("one") / name).empty()) << name;
    EXPECT_EQ(slurp(in("one") / name), slurp(in("seven") / name)) << name;
  }
  const auto json = nlohmann::json::parse(slurp(in("one") / "evidence.json"));
  EXPECT_EQ(json["kind"], "identify");
  EXPECT_EQ(json["root"], "ins0");
  ASSERT_EQ(json["joints"].size(), 2u);
  EXPECT_EQ(json["joints"][1]["parent"], "ins1");
  EXPECT_EQ(json["joints"][1]["type"], "revolute");
  EXPECT_EQ(json["search"]["engine"], "bp");
  EXPECT_EQ(json["search"]["best"][0].size(), 6u);
  EXPECT_TRUE(json["fit"]["holdout"].contains("ins2"));
}

TEST_F(Identify, TheMjcfHasTheToolWhereTheChainHasIt) {
  simulate();
  ASSERT_EQ(kinfer("identify drive/imu.csv --out machine --quiet").code, 0);
  const auto chain = read_robot_model(in("machine/chain.toml"));
  const auto mjcf = read_robot_model(in("machine/chain.mjcf"), {.base_link = "", .tip_link = "tool"});
  ASSERT_TRUE(chain.has_value()) << chain.error().what;
  ASSERT_TRUE(mjcf.has_value()) << mjcf.error().what;
  const std::vector<std::string> names = active_joint_names(chain->chain);
  ASSERT_EQ(active_joint_names(mjcf->chain), names);
  for (std::uint64_t k = 0; k < 200; ++k) {
    const VectorXd q = laws::random_q(chain->chain, Rng(3).stream(k));
    const Pose expected = forward(chain->chain, q), found = forward(mjcf->chain, q);
    ASSERT_LT((expected.position - found.position).norm(), 1e-9);
    ASSERT_LT((expected.rotation - found.rotation).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST_F(Identify, TheDefaultEngineReachesTheOptimumOfExhaustiveSearch) {
  simulate();
  const auto evidence = [&](const std::string& engine) {
    EXPECT_EQ(
        kinfer("identify drive/imu.csv --links 2 --geometry searched --quiet --out " + engine + " --engine " + engine)
            .code,
        0);
    return nlohmann::json::parse(slurp(in(engine) / "evidence.json"));
  };
  const auto found = evidence("bmp"), certified = evidence("enum");
  EXPECT_THAT(certified["verdict"].get<std::string>(), HasSubstr("no chain of up to 3 leaves fits better"));
  EXPECT_LT(found["search"]["best"][1].back().get<double>(),
            1.002 * certified["search"]["best"][1].back().get<double>());
  EXPECT_LT(found["search"]["evaluations"].get<int>(), 5000);
}

TEST_F(Identify, AnUpdateSaysWhatChangedAndKeepsStructureAndNames) {
  simulate();
  ASSERT_EQ(kinfer("simulate excavator --excitation together --out later --seed 2 --grade noise --quiet").code, 0);
  ASSERT_EQ(kinfer("identify drive/imu.csv --out machine --quiet").code, 0);
  const auto one = kinfer("identify --update machine later/imu.csv --out one --threads 1");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("nothing changed since the last identification"));
  ASSERT_EQ(kinfer("identify --update machine/chain.toml later/imu.csv --out seven --threads 7 --quiet").code, 0);
  for (const char* name : {"chain.toml", "track.toml", "chain.urdf"})
    EXPECT_EQ(slurp(in("one") / name), slurp(in("seven") / name)) << name;
  const auto json = nlohmann::json::parse(slurp(in("one") / "evidence.json"));
  EXPECT_TRUE(json["update"]["changes"].empty());
  EXPECT_EQ(json["update"]["parts"].size(), 20u) << "axis and point of five joints, in two sensors each";
  EXPECT_EQ(active_joint_names(read_robot_model(in("one/chain.toml"))->chain),
            active_joint_names(read_robot_model(in("machine/chain.toml"))->chain));
  EXPECT_EQ(kinfer("track one later/imu.csv --out work --quiet").code, 0) << "the updated chain is tracked";

  const auto again = kinfer("identify --update one later/imu.csv --out none");
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("was identified from this recording, which would count twice"));
  const auto first = kinfer("identify --update one drive/imu.csv --out none");
  EXPECT_EQ(first.code, 2) << "the recording before the last";
  EXPECT_THAT(first.err, HasSubstr("was identified from this recording, which would count twice"));
  ASSERT_EQ(kinfer("convert later/imu.csv later/copy.mcap").code, 0);
  const auto copy = kinfer("identify --update one later/copy.mcap --out none");
  EXPECT_EQ(copy.code, 2);
  EXPECT_THAT(copy.err, HasSubstr("which holds all of the same measurements"));
  const auto tree = kinfer("identify --update machine later/imu.csv --out none --tree ins0-ins1");
  EXPECT_EQ(tree.code, 2);
  EXPECT_THAT(tree.err, HasSubstr("--tree has no effect with --update"));
  const auto engine = kinfer("identify --update machine later/imu.csv --out none --generations 5");
  EXPECT_EQ(engine.code, 2);
  EXPECT_THAT(engine.err, HasSubstr("--generations: no effect with --update"));
  ASSERT_EQ(kinfer("simulate crane --out other --grade noise --quiet").code, 0);
  const auto other = kinfer("identify --update machine other/imu.csv --out none");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("the log has no sensor ins5 of the chain"));
  EXPECT_EQ(kinfer("identify --update drive later/imu.csv --out none").code, 2) << "no chain there";
}

TEST_F(Identify, BadInputGivesOneSentenceAndNoOutput) {
  write(in("one.csv"), "t,a_ax,a_ay,a_az,a_gx,a_gy,a_gz\n0,0,0,9.8,0,0,0\n0.01,0,0,9.8,0,0,0\n0.02,0,0,9.8,0,0,0\n");
  const auto lonely = kinfer("identify one.csv --out out");
  EXPECT_EQ(lonely.code, 2);
  EXPECT_THAT(lonely.err, HasSubstr("two sensors"));
  simulate();
  const auto nobody = kinfer("identify drive/imu.csv --out out --root nobody");
  EXPECT_EQ(nobody.code, 2);
  EXPECT_THAT(nobody.err, HasSubstr("nobody"));
  const auto depth = kinfer("identify drive/imu.csv --out out --engine bp --min-depth 4 --max-depth 2");
  EXPECT_EQ(depth.code, 2);
  EXPECT_THAT(depth.err, HasSubstr("--max-depth"));
  EXPECT_EQ(kinfer("identify drive/imu.csv --out out --filter magic").code, 2);
  EXPECT_EQ(kinfer("identify drive/imu.csv --out out --engine magic").code, 2);
  EXPECT_FALSE(std::filesystem::exists(in("out") / "evidence.json"));
}

TEST_F(Identify, AnOptionWithoutEffectIsRefusedInOneSentence) {
  simulate();
  const auto refusal = [&](const std::string& options) {
    const auto run = kinfer("identify drive/imu.csv --out out " + options);
    EXPECT_EQ(run.code, 2) << options;
    return run.err;
  };
  EXPECT_THAT(refusal("--max-depth 3"), HasSubstr("--max-depth: no effect with --engine bmp"));
  EXPECT_THAT(refusal("--engine enum --clones 3 --pairing halves"),
              HasSubstr("--clones, --pairing: no effect with --engine enum"));
  EXPECT_THAT(refusal("--engine enum --terminals euler"),
              HasSubstr("--terminals euler has no effect with --engine enum"));
  EXPECT_THAT(refusal("--geometry searched --grade noise"), HasSubstr("--grade has no effect"));
  write(in("facts.toml"), "[[tape]]\nfrom = \"ins0-ins1\"\nto = \"ins1-ins2\"\nlength = 1.0\nsigma = 0.001\n");
  EXPECT_THAT(refusal("--geometry searched --facts facts.toml"), HasSubstr("--facts has no effect"));
  EXPECT_FALSE(std::filesystem::exists(in("out")));
}

}  // namespace
}  // namespace kinfer
