// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>

#include "kinfer/base/temporary_paths.hpp"
#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/terminal.hpp"

namespace kinfer::cli {
namespace {

char out_of_memory[160] = "";  // written when the limit is set: then there is memory
char out_of_time[160] = "";    // written before the timer starts: a signal handler can print it, but not make it

ProcessLimits& stated_limits() {
  static ProcessLimits limits;
  return limits;
}

void say(std::string_view text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

void end_interrupted(int signal) {
  remove_temporary_paths();
  ::_exit(128 + signal);
}

void end_out_of_time(int) {
  say(std::string_view(out_of_time));
  remove_temporary_paths();
  ::_exit(exit_bad_input);
}

void on(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigfillset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

/// Where one was closed, the next file that is opened would take its place.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) {
      [[maybe_unused]] const int opened = ::open("/dev/null", O_RDWR);
      if (stream == STDOUT_FILENO) expect_no_data();
    }
}

}  // namespace

void prepare_process() {
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is an error of its write
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) on(signal, end_interrupted);  // nohup, or a shell's background job
  }
}

bool enlarge_stack() {
  constexpr rlim_t enough = 1 << 20, usual = 8 << 20;  // the suite needs 0.25 MB; of Eigen's products 128 kB at once
  rlimit bounds{};
  if (::getrlimit(RLIMIT_STACK, &bounds) != 0) return true;
  bounds.rlim_cur = std::max(bounds.rlim_cur, std::min(bounds.rlim_max, usual));
  ::setrlimit(RLIMIT_STACK, &bounds);
  pthread_attr_t threads;
  if (std::size_t size = 0; ::pthread_getattr_default_np(&threads) == 0) {
    ::pthread_attr_getstacksize(&threads, &size);
    ::pthread_attr_setstacksize(&threads, std::max<std::size_t>(size, usual));
    ::pthread_setattr_default_np(&threads);
    ::pthread_attr_destroy(&threads);
  }
  if (bounds.rlim_cur >= enough) return true;
  print_message("kinfer: the stack is limited to {} kB; 1024 kB are needed (ulimit -s)\n", bounds.rlim_cur / 1024);
  return false;
}

ProcessLimits process_limits() {
  return stated_limits();
}

void limit_memory(double gigabytes) {
  stated_limits().memory = gigabytes;
  const bool is_limited = gigabytes > 0.0;
  const auto end = fmt::format_to_n(
      out_of_memory, sizeof(out_of_memory) - 1, "kinfer: this input takes more memory than {}\n",
      is_limited ? fmt::format("the limit, {:g} GB; --limit-memory {:g} allows more, 0 any", gigabytes, 4.0 * gigabytes)
                 : "there is");
  *end.out = '\0';
#if !defined(__SANITIZE_ADDRESS__)
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  return;  // it reserves terabytes of addresses
#endif
#endif
  if (!is_limited) return;
  rlimit bounds{};
  ::getrlimit(RLIMIT_DATA, &bounds);
  bounds.rlim_cur = std::min(bounds.rlim_max, static_cast<rlim_t>(gigabytes * 1e9));
  ::setrlimit(RLIMIT_DATA, &bounds);
#endif
}

int code_of_exception() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    say(out_of_memory);
    return exit_bad_input;
  } catch (const std::filesystem::filesystem_error& failure) {
    print_message("kinfer: \"{}\": {}\n", failure.path1().string(), failure.code().message());
    return exit_bad_input;
  } catch (const std::exception& failure) {
    if (!flush_standard_output()) return exit_bad_input;
    print_message("kinfer: internal error: {}\n", failure.what());
    return exit_internal;
  }
}

void limit_time(double seconds) {
  stated_limits().time = seconds;
  const auto end = fmt::format_to_n(out_of_time, sizeof(out_of_time) - 1,
                                    "kinfer: not done after {:g} s, nothing was written; --limit-time {:g} gives it "
                                    "ten times as long, 0 any time\n",
                                    seconds, 10.0 * seconds);
  *end.out = '\0';
  on(SIGALRM, end_out_of_time);
  const double whole = std::floor(seconds);
  const itimerval timer{.it_interval = {},
                        .it_value = {static_cast<time_t>(whole), static_cast<suseconds_t>(1e6 * (seconds - whole))}};
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

bool flush_standard_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && !is_data_lost()) return true;
  print_message(
      "kinfer: standard output cannot be written; is it closed, or the disk full? Result files, if any, are "
      "complete\n");
  return false;
}

}  // namespace kinfer::cli
