// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/sweep/task_pool.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>

#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/process.hpp"
#include "kinfer/cli/parts/program.hpp"

namespace kinfer::cli {
namespace {

/// The program in a process of its own; what it throws ends it as in main.
int run_task(Program& program, const std::vector<std::string>& words) {
  try {
    return program.run(words);
  } catch (const std::exception&) {
    return code_of_exception();
  }
}

void redirect(int descriptor, const std::filesystem::path& file) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (opened < 0) return;
  ::dup2(opened, descriptor);
  ::close(opened);
}

}  // namespace

TaskPool::TaskPool(int workers) : workers_(workers), program_(std::make_unique<Program>()) {}

TaskPool::~TaskPool() = default;

bool TaskPool::start(int task, const std::vector<std::string>& words, const TaskContext& context) {
  std::fflush(nullptr);  // or the child would print what is buffered here again
  const pid_t process = ::fork();
  if (process < 0) return false;
  if (process == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nothing goes on after the sweep was killed
    redirect(STDOUT_FILENO, context.folder / "output.txt");
    redirect(STDERR_FILENO, context.folder / "messages.txt");
    set_task_context(context);
    const int code = run_task(*program_, words);
    std::fflush(nullptr);
    ::_exit(code);  // without destructors of the parent's objects
  }
  running_[process] = task;
  return true;
}

EndedTask TaskPool::wait() {
  for (;;) {
    int status = 0;
    const pid_t process = ::waitpid(-1, &status, 0);
    if (process < 0 && errno == EINTR) continue;
    const auto found = running_.find(process);
    if (found == running_.end()) continue;
    const EndedTask ended{.task = found->second,
                          .exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 3,
                          .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0};
    running_.erase(found);
    return ended;
  }
}

}  // namespace kinfer::cli
