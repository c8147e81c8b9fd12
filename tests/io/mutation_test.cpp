// SPDX-License-Identifier: Apache-2.0
// Readers of input files: any bytes give either a value or an error of one sentence, never a crash.
#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/patch/mjcf_patch.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "support/mjcf_samples.hpp"

namespace kinfer {
namespace {

constexpr int trials = 3000;

/// Overwrites, inserts, deletes and repeats a few bytes; half of the new bytes are syntax characters of the formats.
std::string mutated(std::string text, Rng rng) {
  constexpr std::string_view meaningful = "\",.;#[]{}=<>/&\n\r\t -+0e9naif\xEF\xBB\xBF\xFF";
  const int edits = 1 + static_cast<int>(rng.index(6));
  for (int i = 0; i < edits && !text.empty(); ++i) {
    const std::size_t at = rng.index(text.size());
    const char byte = rng.index(2) ? meaningful[rng.index(meaningful.size())] : static_cast<char>(rng.index(256));
    const std::size_t length = std::min<std::size_t>(1 + rng.index(20), text.size() - at);
    switch (rng.index(4)) {
      case 0:
        text[at] = byte;
        break;
      case 1:
        text.insert(at, 1, byte);
        break;
      case 2:
        text.erase(at, length);
        break;
      default:
        text.insert(rng.index(text.size()), text.substr(at, length));
    }
  }
  return text;
}

/// Feeds mutations of `good` to `read`; returns how many were refused.
template <class Read>
int refusals(const std::string& good, Read read) {
  int refused = 0;
  for (int i = 0; i < trials; ++i) {
    const std::string text = mutated(good, Rng(11).stream(i));
    const auto result = read(text);
    if (result) continue;
    ++refused;
    EXPECT_FALSE(result.error().what.empty()) << text;
    EXPECT_EQ(result.error().what.rfind("file", 0), 0U) << result.error().what << "\n" << text;
  }
  return refused;
}

/// Every joint moved by a millimetre; the file that is written back has the tool there.
void expect_written_back(const std::string& text, const Chain& in_file) {
  Chain moved = in_file;
  for (Joint& joint : moved.joints)
    if (has_position(joint.type)) std::get<UrdfLink>(joint.link).origin.xyz.x() += 1e-3;
  const auto origins = calibrated_origins(in_file, moved, EncoderOffsets::folded);
  ASSERT_TRUE(origins.has_value()) << origins.error().what;
  const auto ends = mjcf_ends(parse_mjcf_tree(text, "file").value(), "file", {});
  const auto patched = patch_mjcf(text, "file", ends.value(), *origins);
  if (!patched) return;  // XML that tinyxml2 takes and our scanner does not
  const auto written = parse_mjcf(patched->text, "file", ends.value());
  ASSERT_TRUE(written.has_value()) << written.error().what << "\n" << text << "\n" << patched->text;
  const VectorXd q = VectorXd::Constant(dof(moved), 0.3);
  const Pose expected = forward(moved, q), found = forward(*written, q);
  const double size = 1.0 + expected.position.norm();
  EXPECT_LT((expected.position - found.position).norm(), 1e-9 * size) << text;
}

TEST(Mutations, APoseSetIsReadOrRefused) {
  const Chain chain = laws::scara();
  const std::string good =
      "# poses\nq1[deg],q2[deg],q3[mm],q4,x[mm],y[mm],z[mm],qw,qx,qy,qz,id,set,anchor,distance[m],pair\n"
      "1,2,3,4,1000.5,2,3,1,0,0,0,\"a "
      "\"\"b\"\"\",train,1,2.5,\n-1e2,2,3,4,,,,,,,,b,holdout,,0.5,bar\n1,2,3,4,,,,,,,,,,,,bar\n";
  ASSERT_TRUE(parse_pose_set(good, "file", chain).has_value()) << parse_pose_set(good, "file", chain).error().what;
  const int refused = refusals(good, [&](const std::string& text) {
    auto set = parse_pose_set(text, "file", chain);
    EXPECT_TRUE(!set || set->joints.allFinite()) << text;
    return set;
  });
  EXPECT_GT(refused, trials / 4);
  EXPECT_LT(refused, trials);
}

TEST(Mutations, ATableIsReadOrRefused) {
  EXPECT_GT(refusals("t,a,b\n0,1.5,-2e3\n0.1,,nan\n0.2, +7 ,\"8\"\n",
                     [](const std::string& text) { return split_csv(text, "file"); }),
            100);
}

TEST(Mutations, ARobotFileIsReadOrRefusedAndWhatIsReadCanMove) {
  const int refused = refusals(format_robot_toml({.chain = laws::compliant_tree()}), [](const std::string& text) {
    auto robot = parse_robot_toml(text, "file");
    if (robot)
      forward(robot->chain, VectorXd(VectorXd::Zero(dof(robot->chain))));  // stops where the chain is not well formed
    return robot;
  });
  EXPECT_GT(refused, trials / 4);
  EXPECT_LT(refused, trials);
}

TEST(Mutations, AUrdfIsReadOrRefusedAndWhatIsReadCanMove) {
  const int refused = refusals(format_urdf(laws::coupled()), [](const std::string& text) {
    auto chain = parse_urdf(text, "file");
    if (chain) forward(*chain, VectorXd(VectorXd::Zero(dof(*chain))));
    return chain;
  });
  EXPECT_GT(refused, trials / 4);
  EXPECT_LT(refused, trials);
}

TEST(Mutations, AnMjcfIsReadOrRefusedAndWhatIsReadIsWrittenBackWithTheSamePoses) {
  const int refused = refusals(test::awkward_mjcf(), [](const std::string& text) {
    auto chain = parse_mjcf(text, "file");
    if (chain) expect_written_back(text, *chain);
    return chain;
  });
  EXPECT_GT(refused, trials / 4);
  EXPECT_LT(refused, trials);
}

TEST(Mutations, AColumnMapIsReadOrRefused) {
  refusals(
      "delimiter = \";\"\ndecimal = \",\"\nskip_lines = 1\neuler = \"XYZ intrinsic\"\n[columns]\nq1 = \"a [deg]\"\n",
      [](const std::string& text) { return parse_column_map(text, "file"); });
}

}  // namespace
}  // namespace kinfer
