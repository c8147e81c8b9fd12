// SPDX-License-Identifier: Apache-2.0
// Tasks of a sweep in processes of their own, so that a crash of one is a result and not the end of all.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kinfer/cli/sweep/task_context.hpp"

namespace kinfer::cli {

class Program;

struct EndedTask {
  int task = 0;
  int exit_code = 0;
  int signal = 0;  ///< that ended it; 0: none
};

class TaskPool {
 public:
  explicit TaskPool(int workers);
  ~TaskPool();
  TaskPool(const TaskPool&) = delete;
  TaskPool& operator=(const TaskPool&) = delete;

  bool is_full() const { return static_cast<int>(running_.size()) >= workers_; }
  bool is_empty() const { return running_.empty(); }

  /// Starts the program with these words; what it prints goes to output.txt and messages.txt in the context's folder.
  /// False where no process can be made.
  bool start(int task, const std::vector<std::string>& words, const TaskContext& context);

  /// Waits until a task ends.
  EndedTask wait();

 private:
  int workers_;
  std::unique_ptr<Program> program_;  // each task runs its process's copy
  std::map<int, int> running_;        // process → task
};

}  // namespace kinfer::cli
