// SPDX-License-Identifier: Apache-2.0
// What kinfer promises of every run: typed ranges, all or nothing, one run a folder, sentences for what the system
// denies.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/mount.h>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Trust : public Program {
 protected:
  std::string poses(const std::string& out, const std::string& more = "") const {
    return "simulate-poses --robot " + source("examples/robot6/robot.toml") + " --poses 5 --out " + out + " " + more;
  }
  std::vector<std::string> hidden() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.path().filename().string().find("kinfer-") != std::string::npos ||
          entry.path().extension() == ".unfinished")
        names.push_back(entry.path().string());
    return names;
  }
};

TEST_F(Trust, NumbersOutsideOfTheirRangeAreRefusedByTheParser) {
  for (const std::string arguments :
       {"simulate crane --out o --rate nan", "simulate crane --out o --slope inf",
        "identify a.csv --out o --smoothing nan", "calibrate --robot r --data d --out o --method pso --box-length inf",
        "simulate-poses --robot r --out o --sigma -1", "plan --robot r --out o --clearance 1e300",
        "--limit-time nan man"}) {
    const Outcome run = kinfer(arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr("expected a number from")) << arguments;
  }
}

TEST_F(Trust, ASeedIsAWholeNumberThatFits) {
  for (const std::string seed : {"-1", "18446744073709551616", "1.5", "x"})
    EXPECT_THAT(kinfer(poses("out", "--seed " + seed)).err, HasSubstr("expected a whole number from 0 to")) << seed;
  EXPECT_EQ(kinfer(poses("out", "--seed 18446744073709551615")).code, 0);
}

TEST_F(Trust, RowsAndJsonDoNotShareStandardOutput) {
  const std::string robot = source("examples/robot6/robot.toml"), ends = " --from 0,0,0,0,0,0 --to 10,0,0,0,0,0 --json";
  EXPECT_EQ(kinfer("path " + robot + ends).code, 2);
  for (const std::string& arguments : {"path " + robot + ends, "reach " + robot + " --targets t.csv --json",
                                       "compensate " + robot + " --nominal " + robot + " --joints j.csv --json"})
    EXPECT_THAT(kinfer(arguments).err, HasSubstr("--json: needs -o FILE")) << arguments;
  EXPECT_THAT(kinfer("path " + robot + ends + " -o path.csv").out, HasSubstr("\"duration_s\""));
}

TEST_F(Trust, WhatAClosedStandardOutputLosesIsSaid) {
  ASSERT_EQ(kinfer(poses("data")).code, 0);
  const std::string predict = "predict data/robot.toml --joints data/poses.csv ";
  EXPECT_EQ(kinfer(predict + ">&- 2>closed.txt; code=$?; (exit $code)").code, 2);
  EXPECT_THAT(slurp(in("closed.txt")), HasSubstr("standard output cannot be written; is it closed"));
  const Outcome whole = kinfer(predict + "--quiet");
  EXPECT_EQ(whole.code, 0);
  EXPECT_EQ(kinfer(predict + "--quiet -o poses.csv >&-; code=$?; (exit $code)").code, 0);
  EXPECT_EQ(slurp(in("poses.csv")), whole.out);
}

TEST_F(Trust, JointsComeFromAPipe) {
  ASSERT_EQ(kinfer(poses("data")).code, 0);
  const std::string predict = "predict data/robot.toml --quiet --joints ";
  const Outcome file = kinfer(predict + "data/poses.csv");
  EXPECT_EQ(kinfer(predict + "/dev/stdin < data/poses.csv").out, file.out);
  EXPECT_EQ(kinfer("--version >/dev/null; cat data/poses.csv | '" KINFER_PROGRAM "' " + predict + "/dev/stdin").out,
            file.out);
}

TEST_F(Trust, FilesBeyondTheLimitOfTheirSizeLeaveNothing) {
  ASSERT_EQ(kinfer(poses("data")).code, 0);
  const Outcome run =
      kinfer("--version >/dev/null; ulimit -f 4; '" KINFER_PROGRAM "' " + poses("out", "--quiet") + " --poses 2000");
  EXPECT_EQ(run.code, 2);
  EXPECT_FALSE(fs::exists(in("out/poses.csv")));
  EXPECT_TRUE(hidden().empty());
}

TEST_F(Trust, WithoutAnotherDescriptorNothingIsLeft) {
  ASSERT_EQ(kinfer(poses("data")).code, 0);
  for (const int limit : {4, 5, 6}) {
    const Outcome run = kinfer(fmt::format("--version >/dev/null; ulimit -n {}; '" KINFER_PROGRAM "' ", limit) +
                               poses("out", "--quiet"));
    if (run.code != 0) EXPECT_FALSE(fs::exists(in("out"))) << limit;
    EXPECT_TRUE(hidden().empty()) << limit;
  }
}

TEST_F(Trust, ASmallStackIsEnlargedOrASentence) {
  ASSERT_EQ(kinfer(poses("data")).code, 0);
  const std::string calibrate =
      "'" KINFER_PROGRAM "' calibrate --robot data/robot.toml --data data/poses.csv --out out --quiet";
  EXPECT_LE(kinfer("--version >/dev/null; ulimit -S -s 128; " + calibrate).code, 1);
  const Outcome refused = kinfer("--version >/dev/null; ulimit -s 128; " + calibrate);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("the stack is limited to 128 kB"));
}

TEST_F(Trust, APlanBesideADeviceIsRefused) {
  const Outcome run = kinfer("plan --robot " + source("examples/robot6/robot.toml") + " --poses 8 -o /dev/null");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("-o /dev/null: expected the name of a file"));
}

/// Log rotation: the log was mapped, and the program ended by SIGBUS.
TEST_F(Trust, ALogThatIsCutWhileItIsReadIsASentence) {
  std::string log = "t,a_ax,a_ay,a_az,a_gx,a_gy,a_gz\n";
  for (int i = 0; i < 900000; ++i)
    log += fmt::format("{},0.125,-0.25,9.8125,0.0{:05},0,-0.5\n", 0.01 * i, i * 7919LL % 99991);
  bool was_cut = false;
  for (int delay = 2; delay < 40; delay += 2) {
    write(in("log.csv"), log);
    const Outcome run = kinfer(fmt::format(
        "orient log.csv -o q.csv --quiet 2>said.txt & (sleep 0.0{:02}; : > log.csv); wait $!; code=$?; (exit $code)",
        delay));
    EXPECT_THAT(run.code, ::testing::AnyOf(0, 2)) << delay;
    was_cut |= run.code == 2;
    EXPECT_EQ(run.code == 2, slurp(in("said.txt")).starts_with("kinfer: log.csv: ")) << slurp(in("said.txt"));
    if (run.code == 0) break;
  }
  EXPECT_TRUE(was_cut);
}

TEST_F(Trust, NamesCannotCommandTheTerminal) {
  std::string log = "t,a\x1B[31m_ax,a\x1B[31m_ay,a\x1B[31m_az,a\x1B[31m_gx,a\x1B[31m_gy,a\x1B[31m_gz\n";
  for (int i = 0; i < 50; ++i) log += fmt::format("{},0,0,9.8,0.0{},0,0\n", 0.01 * i, i % 7);
  write(in("log.csv"), log);
  const Outcome run = kinfer("inspect log.csv");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("a?[31m"));
  EXPECT_THAT(run.out, Not(HasSubstr("\x1B")));
}

TEST_F(Trust, HostileNamesAreShownByEveryVerb) {
  const std::string hostile = "\x1B[31m\xC2\x9B\x7F";  // ESC, the one-character CSI of C1, DEL
  std::string robot = slurp(source("examples/robot6/robot.toml")), log = "t";
  const auto replace = [&](const std::string& what, const std::string& by) {
    for (std::size_t at = robot.find(what); at != std::string::npos; at = robot.find(what, at + by.size()))
      robot.replace(at, what.size(), by);
  };
  replace("name = \"", "name = \"\\u001b[31m\\u009b\\u007f");
  for (std::size_t at = robot.find("[[joint]]"), k = 1; at != std::string::npos; at = robot.find("[[joint]]", at + 9))
    robot.insert(at + 9, fmt::format("\nname = \"J{}\\u001b[31m\\u009b\\u007f\"", k++));
  write(in("r.toml"), robot);
  for (const char* channel : {"ax", "ay", "az", "gx", "gy", "gz"}) log += "," + hostile + "_" + channel;
  for (int i = 0; i < 50; ++i) log += fmt::format("\n{},0,0,9.8,0.0{},0,0", 0.01 * i, i % 7);
  write(in("log.csv"), log + "\n");
  for (const std::string& arguments :
       {std::string("path r.toml --from 200,0,0,0,0,0 --to 0,0,0,0,0,0 -o path.csv"),
        std::string("simulate-poses --robot r.toml --poses 12 --out p"),
        std::string("inspect p/poses.csv --robot r.toml"), std::string("inspect log.csv --allan"),
        std::string("orient log.csv -o q.csv"), "convert r.toml '" + hostile + ".urdf'", "'" + hostile + "'",
        "plan '--" + hostile + "'", "plan --robot r.toml -o x.csv --poses '" + hostile + "'",
        "predict r.toml --joints p/poses.csv -o '" + hostile + ".csv'"}) {
    const Outcome run = kinfer(arguments);
    const std::string shown = run.out + run.err;
    EXPECT_THAT(shown, HasSubstr("?[31m??")) << arguments;
    for (const char* control : {"\x1B", "\xC2\x9B", "\x7F"}) EXPECT_THAT(shown, Not(HasSubstr(control))) << arguments;
  }
  EXPECT_THAT(kinfer("inspect log.csv --json").out, HasSubstr("\\u001b[31m\\u009b\\u007f")) << "data keep the names";
}

TEST_F(Trust, BytesOfOtherCharacterSetsCannotCommandTheTerminal) {
  const Outcome run = kinfer("'b\x9B[31m\x85m\xC3\xBC\xE2\x80\xAE'");
  EXPECT_THAT(run.err, HasSubstr("b?[31m?m\xC3\xBC?")) << run.err;
}

TEST_F(Trust, UsageErrorsAreInOurWords) {
  const std::pair<const char*, const char*> cases[] = {
      {"plan --robot r --poses 1 --poses 2 -o x", "--poses: given 2 times, expected once"},
      {"inspect x -o y", "inspect: expected nothing like \"-o\" here"},
      {"simulate excavator extra --out x", "simulate: expected nothing like \"extra\" here"},
      {"plan --robot r --poses 3.5 -o x", "--poses: expected a whole number from 1 to"},
      {"plan --robot r --poses 1e2 -o x", "--poses: expected a whole number from 1 to"},
      {"identify x --engine foo --out o", "--engine: expected one of bmp, bp, enum, found \"foo\""},
      {"reach r --targets t --base-link=", "--base-link: expected TEXT after it, found none"},
      {"identify x --out", "--out: expected DIR after it, found none"},
      {"identify x --out o --quiet=3", "--quiet: takes no value"},
      {"--kernels x plan", "--kernels: expected one of auto, portable, avx2, avx512, found \"x\""},
      {"--limit-time 3", "expected a verb"},
      {"plan", "--robot is required"}};
  for (const auto& [arguments, sentence] : cases) {
    const Outcome run = kinfer(arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr(std::string("kinfer: ") + sentence)) << arguments;
  }
}

TEST_F(Trust, ResultsOfAnEarlierRunThatAreNotRenewedDoNotStay) {
  const std::string robot = source("examples/robot6/robot.toml");
  ASSERT_EQ(kinfer(poses("out")).code, 0);
  write(in("out/mine.txt"), "mine");
  // As if the earlier run had written one file more, and had been told of one elsewhere.
  write(in("precious"), "mine");
  std::string record = slurp(in("out/run.json"));
  record.replace(record.find("\"poses.csv\""), 11,
                 R"("poses.csv", "old.csv", "../precious", ".", "sub", "poses.csv\u0000x")");
  write(in("out/run.json"), record);
  write(in("out/old.csv"), "old");
  ASSERT_EQ(kinfer(poses("out")).code, 0);
  EXPECT_FALSE(fs::exists(in("out/old.csv")));
  EXPECT_TRUE(fs::exists(in("out/mine.txt")) && fs::exists(in("precious")) && fs::exists(in("out/poses.csv")));
  // Where the folders cannot change places, likewise.
  fs::create_directories(in("out/sub"));
  write(in("out/run.json"), record);
  write(in("out/old.csv"), "old");
  ASSERT_EQ(kinfer(poses("out")).code, 0);
  EXPECT_FALSE(fs::exists(in("out/old.csv")));
  EXPECT_TRUE(fs::exists(in("out/mine.txt")) && fs::exists(in("out/sub")) && fs::exists(in("out/poses.csv")));
}

TEST_F(Trust, WhatIsReadIsNotDropped) {
  const std::string robot = source("examples/robot6/robot.toml");
  ASSERT_EQ(kinfer("simulate-poses --robot " + robot + " --poses 20 --out data").code, 0);
  ASSERT_EQ(kinfer("calibrate --robot " + robot + " --data data/poses.csv --model geometry --out out").code, 0);
  fs::copy_file(in("data/poses.csv"), in("out/poses.csv"));
  std::string record = slurp(in("out/run.json"));
  record.replace(record.find("\"chain.toml\""), 12, R"("chain.toml", "poses.csv")");
  write(in("out/run.json"), record);
  ASSERT_EQ(kinfer("calibrate --robot " + robot + " --data out/poses.csv --model geometry --out out").code, 0);
  EXPECT_TRUE(fs::exists(in("out/poses.csv")));
}

TEST_F(Trust, AResultDoesNotTakeThePlaceOfAnInput) {
  const std::string robot = source("examples/robot6/robot.toml");
  ASSERT_EQ(kinfer("simulate-poses --robot " + robot + " --poses 20 --out data").code, 0);
  fs::create_directories(in("out"));
  fs::copy_file(in("data/poses.csv"), in("out/accuracy.csv"));
  const std::string before = slurp(in("out/accuracy.csv"));
  const std::string calibrate = "calibrate --robot " + robot + " --model geometry --data ";
  const Outcome run = kinfer(calibrate + "out/accuracy.csv --out out");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("out/accuracy.csv: is read, too, and would be lost"));
  EXPECT_EQ(slurp(in("out/accuracy.csv")), before);
  EXPECT_FALSE(fs::exists(in("out/chain.toml")));
  // A result of its own may be renewed, also where an older version has not listed it.
  ASSERT_EQ(kinfer(calibrate + "data/poses.csv --out own").code, 0);
  EXPECT_NE(kinfer("calibrate --robot own/chain.toml --model geometry --data data/poses.csv --out own").code, 2);
  write(in("own/run.json"), R"({"verb": "calibrate"})");
  EXPECT_NE(kinfer("calibrate --robot own/chain.toml --model geometry --data data/poses.csv --out own").code, 2);
}

TEST_F(Trust, ResultsOfTwoVerbsDoNotMix) {
  const std::string robot = source("examples/robot6/robot.toml");
  ASSERT_EQ(kinfer("simulate-poses --robot " + robot + " --poses 20 --out data").code, 0);
  ASSERT_EQ(kinfer("calibrate --robot " + robot + " --data data/poses.csv --model geometry --out out").code, 0);
  const std::string chain = slurp(in("out/chain.toml"));
  const Outcome run = kinfer(poses("out"));
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("out: holds the results of `kinfer calibrate`; give `kinfer simulate-poses` a folder"));
  EXPECT_EQ(slurp(in("out/chain.toml")), chain);
  EXPECT_FALSE(fs::exists(in("out/poses.csv")));
}

TEST_F(Trust, WhatIsPrintedPassesOnePlace) {
  for (const auto& entry : fs::recursive_directory_iterator(source("src/kinfer/cli"))) {
    if (!entry.is_regular_file() || entry.path().filename() == "terminal.cpp") continue;
    const std::string text = slurp(entry.path());
    for (const char* around : {"fmt::print(", "std::cout", "std::cerr", "std::printf("})
      EXPECT_EQ(text.find(around), std::string::npos) << entry.path() << ": print_text, print_message or print_data";
  }
}

TEST_F(Trust, WhatIsReadIsNotWrittenOver) {
  predict_targets("0,-90,90,0,45,0\n");
  const std::string chain = source("examples/robot6/robot.toml"), before = slurp(in("joints.csv"));
  EXPECT_THAT(kinfer("predict --chain " + chain + " --joints joints.csv -o ./joints.csv").err,
              HasSubstr("./joints.csv: is read, too, and would be lost"));
  EXPECT_EQ(slurp(in("joints.csv")), before);
  EXPECT_THAT(kinfer("reach " + chain + " --targets targets.csv -o targets.csv").err, HasSubstr("is read, too"));
  EXPECT_THAT(kinfer("path " + chain + " --targets targets.csv -o targets.csv").err, HasSubstr("is read, too"));
  write(in("columns.toml"), "");
  for (const std::string arguments : {"predict", "plan"})
    EXPECT_THAT(kinfer(arguments + (arguments == "plan" ? " --robot " : " --joints joints.csv --chain ") + chain +
                       " --columns columns.toml -o columns.toml")
                    .err,
                HasSubstr("is read, too"));
  ASSERT_EQ(kinfer("convert " + chain + " robot.toml").code, 0);
  const std::string robot = slurp(in("robot.toml"));
  EXPECT_THAT(kinfer("convert robot.toml robot.toml").err, HasSubstr("is read, too"));
  EXPECT_THAT(kinfer("plan --robot robot.toml --poses 8 -o robot.toml").err, HasSubstr("is read, too"));
  EXPECT_THAT(kinfer("plan --robot robot.toml --poses 8 --data joints.csv -o joints.csv").err,
              HasSubstr("is read, too"));
  EXPECT_THAT(kinfer("plan --robot robot.toml --poses 8 --candidates joints.csv -o joints.csv").err,
              HasSubstr("is read, too"));
  EXPECT_EQ(slurp(in("robot.toml")), robot);
  write(in("imu.csv"), before);
  EXPECT_THAT(kinfer("orient imu.csv -o imu.csv").err, HasSubstr("is read, too"));
  EXPECT_EQ(slurp(in("imu.csv")), before);
  EXPECT_EQ(slurp(in("joints.csv")), before);
  EXPECT_EQ(kinfer("predict --chain " + chain + " --joints joints.csv -o again.csv").code, 0);
  EXPECT_EQ(kinfer("predict --chain " + chain + " --joints joints.csv -o again.csv").code, 0) << "results are renewed";
}

TEST_F(Trust, HoldoutIsAFraction) {
  simulate();
  for (const std::string value : {"nan", "inf", "0", "1", "-0.5"})
    EXPECT_EQ(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out c --holdout " + value).code, 2);
}

TEST_F(Trust, OtherFilesInTheFolderStay) {
  fs::create_directories(in("out"));
  write(in("out/notes.txt"), "mine");
  ASSERT_EQ(kinfer(poses("out")).code, 0);
  ASSERT_EQ(kinfer(poses("out", "--seed 2")).code, 0);
  EXPECT_EQ(slurp(in("out/notes.txt")), "mine");
  EXPECT_TRUE(fs::exists(in("out/poses.csv")));
  EXPECT_THAT(hidden(), ::testing::IsEmpty());
}

TEST_F(Trust, TheCurrentFolderAndFoldersWithFoldersTakeResults) {
  fs::create_directories(in("out/sub"));
  write(in("out/sub/file"), "mine");
  ASSERT_EQ(kinfer(poses(".")).code, 0);
  ASSERT_EQ(kinfer(poses("out")).code, 0);
  EXPECT_EQ(slurp(in("out/sub/file")), "mine");
  EXPECT_TRUE(fs::exists(in("poses.csv")) && fs::exists(in("out/poses.csv")));
  EXPECT_THAT(hidden(), ::testing::IsEmpty());
}

TEST_F(Trust, AnOutputFolderMayBeALinkButNotAFile) {
  fs::create_directories(in("real"));
  fs::create_directory_symlink(in("real"), in("link"));
  ASSERT_EQ(kinfer(poses("link")).code, 0);
  EXPECT_TRUE(fs::is_symlink(in("link")) && fs::exists(in("real/poses.csv")));
  write(in("file"), "mine");
  EXPECT_EQ(kinfer(poses("file")).code, 2);
  EXPECT_EQ(slurp(in("file")), "mine");
}

TEST_F(Trust, ASecondRunIntoOneFolderIsRefused) {
  fs::create_directories(in("out"));
  const int lock = ::open(in("out").c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  const Outcome run = kinfer(poses("out"));
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("another run"));
  ::close(lock);
  EXPECT_EQ(kinfer(poses("out")).code, 0);
}

TEST_F(Trust, WhatAKilledRunLeftIsRemovedByTheNext) {
  fs::create_directories(in(".out.kinfer-1"));
  write(in(".out.kinfer-1/poses.csv"), "half");
  ASSERT_EQ(kinfer(poses("out")).code, 0);
  EXPECT_THAT(hidden(), ::testing::IsEmpty());
}

TEST_F(Trust, AFullDiskIsASentence) {
  EXPECT_EQ(std::system(("'" KINFER_PROGRAM "' man calibrate > /dev/full 2> " + in("err").string()).c_str()) >> 8, 2);
  EXPECT_THAT(slurp(in("err")), HasSubstr("standard output cannot be written"));
  EXPECT_EQ(
      std::system(
          ("cd " + folder_.string() + " && '" KINFER_PROGRAM "' " + poses("full") + " > /dev/full 2> err").c_str()) >>
          8,
      2);
  EXPECT_THAT(slurp(in("err")), HasSubstr("Result files, if any, are complete"));
  EXPECT_TRUE(fs::exists(in("full/poses.csv"))) << "results are in place before the summary is printed";
  fs::create_directories(in("small"));
  if (::mount("none", in("small").c_str(), "tmpfs", 0, "size=16k") != 0) GTEST_SKIP() << "needs root";
  const Outcome run =
      kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") + " --poses 500 --out small/out");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("the disk is full"));
  EXPECT_TRUE(fs::is_empty(in("small")));
  ::umount(in("small").c_str());
}

TEST_F(Trust, ClosedStandardStreamsDoNoHarm) {
  EXPECT_EQ(
      std::system(("cd " + folder_.string() + " && '" KINFER_PROGRAM "' " + poses("out") + " >&- 2>&- <&-").c_str()),
      0);
  EXPECT_THAT(slurp(in("out/poses.csv")), ::testing::StartsWith("q1"));
}

TEST_F(Trust, AnInterruptEndsAtOnceAndLeavesNothing) {
  const std::string command = "cd " + folder_.string() +
                              " && timeout -s INT 0.3 '" KINFER_PROGRAM
                              "' simulate crane --duration 600 --rate 2000 --out out; echo $? > code";
  ASSERT_EQ(std::system(("bash -c \"" + command + "\" > /dev/null 2>&1").c_str()), 0);
  EXPECT_FALSE(fs::exists(in("out")));
  EXPECT_THAT(hidden(), ::testing::IsEmpty());
}

TEST_F(Trust, TimeAndMemoryHaveLimits) {
  const Outcome late =
      kinfer("--limit-time 0.2 plan --robot " + source("examples/robot6/robot.toml") + " --poses 60 --out out");
  EXPECT_EQ(late.code, 2);
  EXPECT_THAT(late.err, HasSubstr("--limit-time"));
  EXPECT_FALSE(fs::exists(in("out")));
  EXPECT_THAT(kinfer("--limit-time 20 man").err, Not(HasSubstr("--limit-time")));
}

TEST_F(Trust, WhatWouldTakeTooMuchIsSaidBeforeTheWork) {
  const Outcome long_one = kinfer("--limit-time 2 simulate crane --duration 1800 --rate 2000 --out out");
  EXPECT_EQ(long_one.code, 2);
  EXPECT_THAT(long_one.err, HasSubstr("3600000 rows of "));
  EXPECT_THAT(long_one.err, HasSubstr("and the limit is 2 s; --limit-time "));
  EXPECT_FALSE(fs::exists(in("out")));
  EXPECT_THAT(kinfer("simulate crane --duration 3600 --rate 2000 --out out").err, HasSubstr("the limit is 8 GB"));
  ASSERT_EQ(kinfer("simulate crane --duration 30 --rate 100 --out log").code, 0);
  EXPECT_THAT(kinfer("--limit-memory 0.0005 identify log/imu.csv --out out").err, HasSubstr("--limit-memory"));
  ASSERT_EQ(kinfer(poses("few")).code, 0);
  EXPECT_THAT(kinfer("--limit-time 0.0001 calibrate --robot few/robot.toml --data few/poses.csv --out out").err,
              HasSubstr("--limit-time"));
}

}  // namespace
}  // namespace kinfer::test
