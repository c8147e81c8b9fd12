// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace kinfer {
namespace {

thread_local bool inside_a_parallel_loop = false;

struct Job {
  std::size_t count = 0;
  const std::function<void(std::size_t)>* body = nullptr;
  std::atomic<std::size_t> next{0};
  std::mutex failing{};
  std::exception_ptr failure{};  ///< of the first item that threw; the items after it are not begun

  void run() {
    inside_a_parallel_loop = true;
    try {
      for (std::size_t i = next++; i < count; i = next++) (*body)(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(failing);
      if (!failure) failure = std::current_exception();
    }
    inside_a_parallel_loop = false;
  }
};

/// Workers sleep until a job is posted; the requested number of them may take part, and the posting thread waits for
/// those that began.
class Pool {
 public:
  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }

  void run(Job& job, int helpers) {
    const std::lock_guard one_job_at_a_time(posting_);
    {
      const std::lock_guard lock(mutex_);
      helpers = std::min(helpers, threads_for(helpers));
      job_ = &job;
      wanted_ = helpers;
      busy_ = helpers;
    }
    wake_.notify_all();
    job.run();
    std::unique_lock lock(mutex_);
    // All items are taken: workers that have not woken yet, on cores with other work, need not.
    busy_ -= wanted_;
    wanted_ = 0;
    done_.wait(lock, [this] { return busy_ == 0; });
    if (job.failure) std::rethrow_exception(job.failure);
  }

 private:
  /// How many workers there are, of that many: fewer where the system gives no more, and no result depends on it.
  int threads_for(int helpers) {
    try {
      while (static_cast<int>(workers_.size()) < helpers) workers_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
    }
    return static_cast<int>(workers_.size());
  }

  void work() {
    // Signals interrupt the thread that began the work: it alone writes results.
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, nullptr);
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return closing_ || wanted_ > 0; });
      if (closing_) return;
      --wanted_;
      Job& job = *job_;
      lock.unlock();
      job.run();
      lock.lock();
      if (--busy_ == 0) done_.notify_all();
    }
  }

  std::mutex posting_, mutex_;
  std::condition_variable wake_, done_;
  std::vector<std::thread> workers_;
  Job* job_ = nullptr;
  int wanted_ = 0, busy_ = 0;
  bool closing_ = false;
};

}  // namespace

int hardware_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  if (threads <= 0) threads = hardware_threads();
  const int helpers = static_cast<int>(std::min<std::size_t>(threads, count)) - 1;
  if (helpers <= 0 || inside_a_parallel_loop) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  static Pool pool;
  Job job;
  job.count = count;
  job.body = &body;
  pool.run(job, helpers);
}

}  // namespace kinfer
