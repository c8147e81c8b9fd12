// SPDX-License-Identifier: Apache-2.0
// Long computations without Python's lock, which Ctrl-C and the progress callback can stop.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "kinfer/base/observer.hpp"

namespace kinfer::python {

/// Runs a computation on a thread of its own. The calling thread waits without the lock, looks for signals twenty times
/// a second (Python handles them on its main thread only) and calls progress(stage, fraction).
class Background {
 public:
  explicit Background(pybind11::object progress) : progress_(std::move(progress)) {}

  void run(const std::function<void(const Observer&)>& work) {
    std::optional<pybind11::error_already_set> interruption;
    {
      const pybind11::gil_scoped_release without_lock;
      std::thread worker([&] { call(work); });
      while (!wait_until_done())
        if (!interruption) interruption = poll();
      worker.join();
      // It holds references of Python: destroyed or thrown with the lock held.
    }
    if (interruption) throw pybind11::error_already_set(*interruption);
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  struct Interrupted {};

  void call(const std::function<void(const Observer&)>& work) {
    try {
      work([this](const Progress& progress) {
        const std::lock_guard lock(mutex_);
        stage_ = progress.detail.empty() ? std::string(progress.stage)
                                         : std::string(progress.stage) + " " + std::string(progress.detail);
        fraction_ = progress.fraction;
        if (stop_) throw Interrupted{};
        return ObserverDecision::proceed;
      });
    } catch (const Interrupted&) {  // the interruption itself is thrown by the calling thread
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    done_ = true;
    finished_.notify_all();
  }

  bool wait_until_done() {
    std::unique_lock lock(mutex_);
    return finished_.wait_for(lock, std::chrono::milliseconds(50), [this] { return done_; });
  }

  /// The exception of a signal handler or of the callback.
  std::optional<pybind11::error_already_set> poll() {
    std::string stage;
    double fraction = 0.0;
    {
      const std::lock_guard lock(mutex_);
      stage = stage_, fraction = fraction_;
    }
    const pybind11::gil_scoped_acquire with_lock;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (!progress_.is_none() && !stage.empty()) progress_(stage, fraction);
    } catch (const pybind11::error_already_set& failure) {
      const std::lock_guard lock(mutex_);
      stop_ = true;
      return failure;
    }
    return std::nullopt;
  }

  pybind11::object progress_;
  std::mutex mutex_;
  std::condition_variable finished_;
  bool done_ = false, stop_ = false;
  std::string stage_;
  double fraction_ = 0.0;
  std::exception_ptr failure_;
};

}  // namespace kinfer::python
