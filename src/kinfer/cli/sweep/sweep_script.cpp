// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/sweep_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace kinfer::cli {
namespace {

struct Engine {
  std::string_view name;
  std::string_view script;  ///< {0}: the command; {1}: the number of shards
};

constexpr std::array<Engine, 5> engines{{
    {"parallel", R"(#!/bin/sh
# GNU parallel: one shard a core; run it again to go on after a crash.
seq 1 {1} | parallel --halt never {0} --shard {{}}/{1}
)"},
    {"slurm", R"(#!/bin/sh
# Slurm: sbatch THIS_FILE. A shard that is requeued goes on where it was.
#SBATCH --job-name=kinfer-sweep
#SBATCH --array=1-{1}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --requeue
exec {0} --workers 1 --shard "$SLURM_ARRAY_TASK_ID/{1}"
)"},
    {"mpi", R"(#!/bin/sh
# Open MPI: one shard a rank. The death of a rank ends the job; run it again to go on.
exec mpirun -n {1} sh -c 'exec {0} --workers 1 --shard "$((OMPI_COMM_WORLD_RANK + 1))/{1}"'
)"},
    {"dask", R"(#!/usr/bin/env python3
# Dask: python3 THIS_FILE [SCHEDULER]. Shards of a worker that dies are run again elsewhere.
import subprocess
import sys

from dask.distributed import Client


def run(part):
    return subprocess.call(f"{0} --workers 1 --shard {{part}}/{1}", shell=True)


if __name__ == "__main__":
    client = Client(sys.argv[1]) if len(sys.argv) > 1 else Client(threads_per_worker=1)
    codes = client.gather(client.map(run, range(1, {1} + 1), pure=False))
    sys.exit(max(codes))
)"},
    {"kubernetes",
     R"(# Kubernetes: kubectl apply -f THIS_FILE. Set the image, and a volume that all pods share at /sweep.
apiVersion: batch/v1
kind: Job
metadata:
  name: kinfer-sweep
spec:
  completions: {1}
  parallelism: {1}
  completionMode: Indexed
  template:
    spec:
      restartPolicy: OnFailure
      containers:
        - name: kinfer
          image: kinfer
          workingDir: /sweep
          command: ["sh", "-c", 'exec {0} --workers 1 --shard "$((JOB_COMPLETION_INDEX + 1))/{1}"']
          volumeMounts: [{{name: sweep, mountPath: /sweep}}]
      volumes:
        - name: sweep
          persistentVolumeClaim: {{claimName: sweep}}
)"},
}};

}  // namespace

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const Engine& engine : engines) names.emplace_back(engine.name);
  return names;
}

std::string sweep_script(const std::string& engine, const std::string& command, int shards) {
  const auto row = std::ranges::find(engines, engine, &Engine::name);
  return row == engines.end() ? std::string() : fmt::format(fmt::runtime(row->script), command, shards);
}

}  // namespace kinfer::cli
