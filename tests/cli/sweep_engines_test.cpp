// SPDX-License-Identifier: Apache-2.0
// The same manifest on every engine that is installed gives the same bytes, also after a worker was killed. Engines
// that are missing are skipped with a message: parallel, openmpi-bin, python3-distributed, slurmctld, slurmd,
// slurm-client and munge of Debian.
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
  ASSERT_EQ(shell("DASK_TEMPORARY_DIRECTORY=$PWD timeout 100 " + python + " cluster.py " + job), 0)
      << slurp(in("engine.txt"));
  expect_same_fleet("dask");
}

/// A cluster of one node on this machine, in the test's folder, until it ends; no service of the system is touched.
constexpr const char* slurm_cluster = R"sh(#!/bin/sh
here=$PWD/slurm; mkdir -p $here/state $here/spool
head -c 128 /dev/urandom > $here/munge.key; chmod 600 $here/munge.key
echo CgroupPlugin=cgroup/v1 > $here/cgroup.conf
cat > $here/slurm.conf <<END
ClusterName=kinfer
SlurmctldHost=$(hostname)(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$here/munge.socket,cred_expire=5
SlurmUser=root
SlurmdUser=root
SlurmctldPort=$1
SlurmdPort=$(($1 + 1))
StateSaveLocation=$here/state
SlurmdSpoolDir=$here/spool
SlurmctldPidFile=$here/slurmctld.pid
SlurmdPidFile=$here/slurmd.pid
SlurmctldLogFile=$here/slurmctld.log
SlurmdLogFile=$here/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MinJobAge=30
NodeName=$(hostname) NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=10 State=UP
END
export SLURM_CONF=$here/slurm.conf
is_alive() { [ -n "$(tr -d '\0' </proc/$1/cmdline 2>/dev/null)" ]; }
end_all() {
  for daemon in slurmd slurmctld munged; do
    process=$(cat $here/$daemon.pid 2>/dev/null) || continue
    kill $process
    tries=0
    while is_alive $process && [ $tries -lt 100 ]; do tries=$((tries + 1)); sleep 0.1; done
  done
}
trap end_all EXIT
munged --force --socket=$here/munge.socket --key-file=$here/munge.key --pid-file=$here/munged.pid \
  --log-file=$here/munged.log --seed-file=$here/munged.seed --num-threads=1 || exit 77
slurmctld -c || exit 77
slurmd || exit 77
tries=0
until sinfo -h -o %T | grep -q idle; do
  tries=$((tries + 1)); [ $tries -lt 60 ] || exit 77; sleep 0.5
done
kill_task() { echo "killed 1 tasks"; scancel --signal=KILL "$(squeue -h -r -o %i | head -1)"; }
# The daemon, the processes that supervise the tasks, and the tasks end at once; then the node comes back.
kill_node() {
  running=$(scontrol listpids | awk '$1 ~ /^[0-9]+$/ { print $1 }')
  supervisors=$(for p in $running; do cut -d' ' -f4 /proc/$p/stat 2>/dev/null; done | sort -u | grep -vx 1)
  daemon=$(cat $here/slurmd.pid)
  kill -9 $daemon $supervisors $running
  while is_alive $daemon; do sleep 0.1; done
  echo "killed $(echo $supervisors | wc -w) tasks"
  slurmd
}
# It happens in the middle; the job is submitted again and does what is left.
(while [ ! -e slurm_runs/t9 ]; do sleep 0.05; done; kill_$3) &
timeout 50 sbatch --wait $2
scancel --user=root
timeout 90 sbatch --wait $2
)sh";

class SlurmAndWhatDies : public SweepEngines, public ::testing::WithParamInterface<const char*> {};

TEST_P(SlurmAndWhatDies, GiveTheSameBytes) {
  if (!has("which slurmctld slurmd sbatch munged"))
    GTEST_SKIP() << "Slurm is not installed (Debian: slurmctld, slurmd, "
                    "slurm-client, munge)";
  if (::geteuid() != 0) GTEST_SKIP() << "Slurm's daemons need root";
  write(in("cluster.sh"), slurm_cluster);
  const int port = 20000 + static_cast<int>(::getpid() % 20000);
  const int status = shell(fmt::format("sh cluster.sh {} {} {}", port, job_file("slurm", 4, "slurm_runs"), GetParam()));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "Slurm does not start here: " << slurp(in("engine.txt"));
  ASSERT_EQ(status, 0) << slurp(in("engine.txt"));
  EXPECT_THAT(slurp(in("engine.txt")), ::testing::ContainsRegex("killed [1-9] tasks"));
  expect_same_fleet("slurm_runs");
}

INSTANTIATE_TEST_SUITE_P(Of, SlurmAndWhatDies, ::testing::Values("task", "node"),
                         [](const auto& dies) { return std::string(dies.param); });

}  // namespace
}  // namespace kinfer
