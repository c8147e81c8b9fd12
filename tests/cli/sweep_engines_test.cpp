// SPDX-License-Identifier: Apache-2.0
// The same manifest on every engine that is installed gives the same bytes, also after a worker was killed. Engines
// that are missing are skipped with a message: parallel, openmpi-bin, python3-distributed of Debian; slurm is not
// tried.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "cli/program.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::slurp;
using test::write;

constexpr int tasks = 60;

class SweepEngines : public test::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    const std::string robot = source("examples/robot6/robot.toml");
    ASSERT_EQ(kinfer("simulate-poses --robot " + robot + " --poses 12 --out data").code, 0);
    std::string text = "key,verb,arguments,robot\n";
    for (int i = 0; i < tasks; ++i)
      text += fmt::format("t{},verify,--chain {} --data {},r{}\n", i, robot,
                          i % 20 == 7 ? "none.csv" : "data/poses.csv", i % 5);
    write(in("manifest.csv"), text);
    ASSERT_EQ(kinfer("sweep manifest.csv --out serial --workers 1").code, 0);
    ASSERT_EQ(kinfer("merge serial --out serial_fleet").code, 0);
  }

  void expect_same_fleet(const std::string& runs) const {
    const Outcome run = kinfer("merge " + runs + " --out fleet");
    ASSERT_EQ(run.code, 0) << run.err;
    for (const char* file : {"table.csv", "fleet.json", "report.html"})
      EXPECT_EQ(slurp(in("fleet/" + std::string(file))), slurp(in("serial_fleet/" + std::string(file))))
          << runs << ": " << file;
  }

  int shell(const std::string& command) const {
    // The job files call `kinfer` by its name.
    const std::string path = fs::path(KINFER_PROGRAM).parent_path().string();
    return std::system(
        fmt::format("cd '{}' && PATH='{}':$PATH && {} >engine.txt 2>&1", folder_.string(), path, command).c_str());
  }
  bool has(const std::string& probe) const { return shell(probe) == 0; }

  std::string job_file(const std::string& engine, int shards, const std::string& runs) const {
    const Outcome run = kinfer(fmt::format("sweep manifest.csv --out {} --print {} --shards {}", runs, engine, shards));
    EXPECT_EQ(run.code, 0) << run.err;
    write(in("job." + engine), run.out);
    return "job." + engine;
  }
};

TEST_F(SweepEngines, TwoProcessesAndThreeShardsInAnyOrder) {
  ASSERT_EQ(kinfer("sweep manifest.csv --out pool --workers 2").code, 0);
  expect_same_fleet("pool");
  for (const char* shard : {"3/3", "1/3", "2/3"})
    ASSERT_EQ(kinfer("sweep manifest.csv --out shards --shard " + std::string(shard)).code, 0) << shard;
  expect_same_fleet("shards");
}

TEST_F(SweepEngines, AKilledSweepGoesOn) {
  shell(
      "sh -c 'kinfer sweep manifest.csv --out killed --workers 1 & pid=$!; "
      "while [ ! -e killed/t10 ]; do sleep 0.01; done; kill -9 $pid; wait $pid; true'");
  ASSERT_FALSE(fs::exists(in("killed/t59"))) << "it was killed too late to show anything";
  ASSERT_EQ(kinfer("merge killed --out partly").code, 0);
  EXPECT_THAT(slurp(in("partly/fleet.json")), ::testing::HasSubstr("\"t59\""));
  ASSERT_EQ(kinfer("sweep manifest.csv --out killed --resume").code, 0);
  expect_same_fleet("killed");
}

TEST_F(SweepEngines, GnuParallel) {
  if (!has("parallel --version")) GTEST_SKIP() << "GNU parallel is not installed (Debian: parallel)";
  ASSERT_EQ(shell("sh " + job_file("parallel", 3, "parallel")), 0) << slurp(in("engine.txt"));
  expect_same_fleet("parallel");
}

TEST_F(SweepEngines, OpenMpiAndARankThatDies) {
  if (!has("mpirun --version")) GTEST_SKIP() << "Open MPI is not installed (Debian: openmpi-bin)";
  // Root and more ranks than cores are refused without these; a test may run as root in a container.
  const std::string settings =
      "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1; ";
  const std::string job = job_file("mpi", 2, "mpi");
  // One rank's sweep is killed in the middle: the job ends, and running it again does what is left.
  shell(settings + "sh " + job +
        " & while [ ! -e mpi/t9 ]; do sleep 0.01; done; "
        "for p in $(pgrep -f 'kinfer sweep .*--shard 2/2'); do [ \"$(readlink /proc/$p/cwd)\" = \"$PWD\" ] && kill -9 "
        "$p; "
        "done; wait; true");
  ASSERT_EQ(shell(settings + "sh " + job), 0) << slurp(in("engine.txt"));
  expect_same_fleet("mpi");
}

TEST_F(SweepEngines, DaskAndAWorkerThatDies) {
  std::string python;
  for (const char* program : {"python3", "/usr/bin/python3"})  // the second is Debian's, where the first is another
    if (python.empty() && has(std::string(program) + " -c 'import dask.distributed'")) python = program;
  if (python.empty()) GTEST_SKIP() << "Dask is not installed (Debian: python3-distributed)";
  const std::string job = job_file("dask", 6, "dask");
  // A cluster of two workers on this machine; one of them is killed while it works, and its shards go to the other.
  write(in("cluster.py"), R"(
import os, signal, subprocess, sys, time
from dask.distributed import Client, LocalCluster

if __name__ == "__main__":
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    client = Client(cluster)
    job = subprocess.Popen([sys.executable, sys.argv[1], cluster.scheduler_address])
    while not os.path.exists("dask/t7") and job.poll() is None:
        time.sleep(0.01)
    os.kill(list(client.run(os.getpid).values())[0], signal.SIGKILL)
    sys.exit(job.wait(60))
)");
  ASSERT_EQ(shell("timeout 100 " + python + " cluster.py " + job), 0) << slurp(in("engine.txt"));
  expect_same_fleet("dask");
}

TEST_F(SweepEngines, Slurm) {
  GTEST_SKIP() << "Slurm needs its daemons and munge; its job file runs the shards that the other engines run";
}

}  // namespace
}  // namespace kinfer
