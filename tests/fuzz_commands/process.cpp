// SPDX-License-Identifier: Apache-2.0
#include "fuzz_commands/process.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

namespace kinfer::fuzz {
namespace {

void limit(decltype(RLIMIT_CPU) resource, std::uint64_t value) {
  const rlimit bounds{value, value};
  ::setrlimit(resource, &bounds);
}

void redirect(int descriptor, const char* file, int flags) {
  const int opened = ::open(file, flags | O_CLOEXEC, 0644);
  if (opened >= 0) ::dup2(opened, descriptor);
}

[[noreturn]] void become(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                         const std::filesystem::path& folder, const Limits& limits) {
  if (::chdir(folder.c_str()) != 0) ::_exit(127);
  redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
  redirect(STDOUT_FILENO, ".stdout", O_WRONLY | O_CREAT | O_TRUNC);
  redirect(STDERR_FILENO, ".stderr", O_WRONLY | O_CREAT | O_TRUNC);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.cpu_seconds));
  limit(RLIMIT_CORE, 0);
  if (limits.memory > 0) limit(RLIMIT_AS, limits.memory);
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  ::_exit(127);
}

}  // namespace

ProcessResult run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder, const Limits& limits, double kill_after,
                          int kill_signal) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  ProcessResult result;
  const pid_t child = ::fork();
  if (child == 0) become(program, arguments, folder, limits);
  int status = 0;
  auto pause = std::chrono::microseconds(200);
  for (bool killed = false; ::waitpid(child, &status, WNOHANG) == 0; std::this_thread::sleep_for(pause)) {
    if (kill_after > 0.0 && !killed && elapsed() >= kill_after) killed = ::kill(child, kill_signal) == 0;
    if (elapsed() > limits.wall_seconds) ::kill(child, SIGKILL), result.timed_out = true;
    if (kill_after == 0.0 && pause < std::chrono::milliseconds(5)) pause *= 2;
  }
  result.seconds = elapsed();
  if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  // The soft limit of the processor time is the hard one too: it kills.
  result.timed_out |= result.signal == SIGXCPU || (result.signal == SIGKILL && kill_after == 0.0);
  result.out = read_bytes(folder / ".stdout");
  result.err = read_bytes(folder / ".stderr");
  return result;
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace kinfer::fuzz
