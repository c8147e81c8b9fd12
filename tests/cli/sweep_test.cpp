// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/mount.h>

#include <map>

#include "cli/program.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::slurp;
using test::write;
using ::testing::HasSubstr;

class Sweep : public test::Program {
 protected:
  /// manifest.csv: pose sets of the example robot, and one task that is refused.
  void write_tasks(int count, const std::string& more = "") const {
    std::string text = "key,verb,arguments\n";
    for (int i = 0; i < count; ++i)
      text +=
          "m" + std::to_string(i) + ",simulate-poses,--robot " + robot() + " --poses 5 --lowest 0 --clearance 350\n";
    write(in("manifest.csv"), text + more);
  }
  std::string robot() const { return source("examples/robot6/robot.toml"); }

  /// Every file below a folder, with its bytes; run.json tells of one run and differs.
  std::map<std::string, std::string> contents(const std::string& folder) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(in(folder)))
      if (entry.is_regular_file() && entry.path().filename() != "run.json" &&
          entry.path().filename().string().front() != '.')
        files[fs::relative(entry.path(), in(folder)).string()] = slurp(entry.path());
    return files;
  }
};

TEST_F(Sweep, RunsEachTaskInAFolderOfItsOwnWithASeedOfItsOwn) {
  write_tasks(4);
  const Outcome run = kinfer("sweep manifest.csv --out runs");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("4 tasks: 4 use, 0 do not use, 0 refused, 0 failed"));
  EXPECT_NE(slurp(in("runs/m0/poses.csv")), slurp(in("runs/m1/poses.csv")));
  EXPECT_THAT(slurp(in("runs/m0/task.json")), HasSubstr("\"exit_code\": 0"));
  EXPECT_EQ(kinfer("sweep manifest.csv --out runs").code, 2);
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs").err, HasSubstr("holds results of a sweep; --resume goes on"));
}

TEST_F(Sweep, GivesTheSameBytesInAnyOrderNumberOfWorkersAndShards) {
  write_tasks(5);
  ASSERT_EQ(kinfer("sweep manifest.csv --out whole --workers 1").code, 0);
  ASSERT_EQ(kinfer("sweep manifest.csv --out parts --shard 2/2 --workers 3").code, 0);
  EXPECT_TRUE(fs::exists(in("parts/m1")) && !fs::exists(in("parts/m0")));
  ASSERT_EQ(kinfer("sweep manifest.csv --out parts --shard 1/2").code, 0);
  EXPECT_EQ(contents("whole"), contents("parts"));
}

TEST_F(Sweep, RefusedTasksAreKeptAsSentencesAndCanBeTriedAgain) {
  write_tasks(1, "bad,predict,--chain none.toml --joints none.csv\n");
  const Outcome run = kinfer("sweep manifest.csv --out runs");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 refused"));
  EXPECT_THAT(run.err, HasSubstr("bad: none.toml: no such file"));
  EXPECT_THAT(slurp(in("runs/bad/task.json")), HasSubstr("\"sentence\": \"none.toml: no such file\""));
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs --resume").out, HasSubstr("(2 were done before)"));
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs --retry").out, HasSubstr("(1 were done before)"));
}

TEST_F(Sweep, SentencesOfRefusedTasksAreTheSameInEveryRun) {
  write(in("manifest.csv"), "key,verb,arguments\nc,convert," + robot() + " {out}/none/x.urdf\n");
  for (const std::string runs : {"a", "b"}) {
    kinfer("sweep manifest.csv --out " + runs);
    kinfer("merge " + runs + " --out merged-" + runs);
  }
  EXPECT_THAT(slurp(in("merged-a/table.csv")), HasSubstr("{out}/none/x.urdf"));
  EXPECT_EQ(contents("merged-a"), contents("merged-b"));
}

TEST_F(Sweep, RowsOfVerbsThatWriteAFileAreKept) {
  ASSERT_EQ(kinfer("simulate-poses --robot " + robot() + " --poses 5 --out data").code, 0);
  write(in("manifest.csv"), "key,verb,arguments\np,predict,data/robot.toml --joints data/poses.csv\n");
  EXPECT_EQ(kinfer("sweep manifest.csv --out runs").code, 0);
  EXPECT_THAT(slurp(in("runs/p/output.txt")), ::testing::StartsWith("x,y,z,"));
}

TEST_F(Sweep, WhatWasKilledInTheMiddleIsDoneByTheNextRun) {
  write_tasks(6);
  ASSERT_EQ(kinfer("sweep manifest.csv --out whole").code, 0);
  fs::create_directories(in("runs/.m2.99999"));
  write(in("runs/.m2.99999/poses.csv"), "half");
  fs::copy(in("whole/m0"), in("runs/m0"), fs::copy_options::recursive);
  fs::copy(in("whole/manifest.csv"), in("runs/manifest.csv"));
  const Outcome run = kinfer("sweep manifest.csv --out runs --resume");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_FALSE(fs::exists(in("runs/.m2.99999")));
  EXPECT_EQ(contents("whole"), contents("runs"));
}

TEST_F(Sweep, AFolderOfAnotherManifestOrOfChangedRowsIsRefused) {
  write_tasks(2);
  ASSERT_EQ(kinfer("sweep manifest.csv --out runs").code, 0);
  write(in("other.csv"), "key,verb,arguments\nx,predict,\n");
  EXPECT_THAT(kinfer("sweep other.csv --out runs --resume").err, HasSubstr("belongs to another manifest"));
  write(in("changed.csv"), "key,verb,arguments\nm0,predict,--chain a\nm1,predict,--chain b\n");
  EXPECT_THAT(kinfer("sweep changed.csv --out runs --resume").err,
              HasSubstr("rows of the manifest have changed since: m0, m1"));
  write_tasks(3);
  EXPECT_EQ(kinfer("sweep manifest.csv --out runs --resume").code, 0) << "rows may be added";
  fs::create_directories(in("full/of"));
  EXPECT_THAT(kinfer("sweep manifest.csv --out full").err, HasSubstr("expected a new or empty folder"));
}

TEST_F(Sweep, TwoSweepsInOneFolderAreRefusedByALockThatDiesWithItsOwner) {
  write_tasks(1);
  fs::create_directories(in("runs"));
  std::FILE* lock = std::fopen(in("runs/.lock").c_str(), "w");
  ASSERT_EQ(::flock(fileno(lock), LOCK_EX), 0);
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs").err, HasSubstr("another sweep works in this folder"));
  std::fclose(lock);
  EXPECT_EQ(kinfer("sweep manifest.csv --out runs").code, 0);
}

TEST_F(Sweep, TasksCanBeMadeFromFiles) {
  for (const char* machine : {"a", "b"}) {
    fs::create_directories(in("robots/" + std::string(machine)));
    write(in("robots/" + std::string(machine) + "/joints.csv"),
          "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg]\n10,-80,70,20,40,-30\n");
  }
  const Outcome run = kinfer("sweep --each 'robots/*/joints.csv' --verb predict --arguments '--chain " + robot() +
                             " --joints {file} -o {out}/poses.csv' --out runs");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(slurp(in("runs/a/poses.csv")), slurp(in("runs/b/poses.csv")));
}

TEST_F(Sweep, AnArchiveUnpacksIntoTheFoldersOfAnUnpackedSweep) {
  write_tasks(5, "bad,predict,--chain none.toml --joints none.csv\n");
  ASSERT_EQ(kinfer("sweep manifest.csv --out whole").code, 0);
  const Outcome run = kinfer("sweep manifest.csv --out packed --pack --shard 1/2");
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_EQ(kinfer("sweep manifest.csv --out packed --pack --shard 2/2").code, 0);
  EXPECT_FALSE(fs::exists(in("packed/m0")));
  EXPECT_THAT(kinfer("sweep manifest.csv --out packed --resume").out, HasSubstr("(6 were done before)"));
  EXPECT_THAT(kinfer("sweep manifest.csv --out packed --retry --pack").out, HasSubstr("(5 were done before)"));
  ASSERT_EQ(std::system(("cd '" + in("packed").string() +
                         "' && mkdir ../unpacked && for f in results*.tar; do tar xf $f -C ../unpacked; done")
                            .c_str()),
            0);
  fs::copy(in("whole/manifest.csv"), in("unpacked/manifest.csv"));
  EXPECT_EQ(contents("whole"), contents("unpacked"));
}

TEST_F(Sweep, ATaskThatAKilledRunHalfPackedIsDoneAgain) {
  write_tasks(3);
  ASSERT_EQ(kinfer("sweep manifest.csv --out runs --pack").code, 0);
  const auto size = fs::file_size(in("runs/results.tar"));
  const std::string whole = slurp(in("runs/results.tar"));
  for (const auto cut : {size - 1, size - 700, size / 2, std::uintmax_t{300}}) {
    fs::resize_file(in("runs/results.tar"), cut);
    ASSERT_EQ(kinfer("sweep manifest.csv --out runs --pack --resume --workers 1").code, 0);
    EXPECT_EQ(fs::file_size(in("runs/results.tar")), size) << "cut at " << cut;
  }
  write(in("runs/results.tar"), whole.substr(0, 512) + std::string(4096, 'x'));
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs --pack --resume").err,
              HasSubstr("runs/results.tar: no task of a sweep at byte 0"));
}

TEST_F(Sweep, AFullDiskEndsItAndWhatIsDoneStays) {
  write_tasks(12);
  fs::create_directories(in("small"));
  if (::mount("none", in("small").c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "needs root";
  for (const char* option : {"", " --pack"}) {
    const std::string out = std::string("small/runs") + (*option ? "2" : "1");
    ASSERT_EQ(::mount("none", in("small").c_str(), "tmpfs", MS_REMOUNT, "size=64k"), 0);
    const Outcome run = kinfer("sweep manifest.csv --workers 1 --out " + out + option);
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr("the disk is full"));
    EXPECT_FALSE(fs::exists(in(out + "/m11")));
    ASSERT_EQ(::mount("none", in("small").c_str(), "tmpfs", MS_REMOUNT, "size=4m"), 0);
    const Outcome again = kinfer("sweep manifest.csv --retry --out " + out + option);
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("12 use, 0 do not use, 0 refused"));
    fs::remove_all(in(out));
  }
  ::umount(in("small").c_str());
}

TEST_F(Sweep, JobFilesNameTheShards) {
  write_tasks(3);
  for (const char* engine : {"parallel", "slurm", "mpi", "dask", "kubernetes"}) {
    const Outcome run = kinfer("sweep manifest.csv --out runs --shards 3 --print " + std::string(engine));
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("kinfer sweep manifest.csv --out runs --seed 1 --resume --quiet")) << engine;
    EXPECT_THAT(run.out, HasSubstr("/3")) << engine;
  }
  EXPECT_FALSE(fs::exists(in("runs")));
}

TEST_F(Sweep, BadInputIsOneSentence) {
  write_tasks(1);
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs --shard 3/2").err, HasSubstr("expected a part from 1 to 2"));
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs --shard two").err,
              HasSubstr("expected a part and the number of parts"));
  EXPECT_THAT(kinfer("sweep --out runs").err, HasSubstr("expected a manifest, or --each"));
  EXPECT_THAT(kinfer("sweep manifest.csv --verb plan --out runs").err, HasSubstr("no effect with a manifest"));
  EXPECT_THAT(kinfer("sweep manifest.csv --out runs --shards 4").err, HasSubstr("no effect without --print"));
  write(in("verbs.csv"), "key,verb,arguments\na,dance,\n");
  EXPECT_THAT(kinfer("sweep verbs.csv --out runs").err, HasSubstr("verbs.csv:2: \"dance\" is no verb"));
}

}  // namespace
}  // namespace kinfer
