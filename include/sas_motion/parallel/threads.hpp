// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace sas_motion {

/// A team of threads that stays and shares tasks. forEach() allocates nothing.
class ThreadTeam {
 public:
  /// Starts `threads` - 1 threads beside the caller's. Where the system refuses some, the others do the work.
  explicit ThreadTeam(int threads) {
    for (int i = 1; i < threads; ++i) {
      try {
        others_.emplace_back([this] { serve(); });
      } catch (const std::system_error&) {
        break;
      }
    }
  }
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;
  ~ThreadTeam() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      leaving_ = true;
    }
    begin_.notify_all();
    for (auto& thread : others_) thread.join();
  }

  /// Calls `work(task)` for 0 <= task < count; each thread takes the next task. An exception of `work` reaches the
  /// caller.
  template <class Work>
  void forEach(std::size_t count, Work&& work) {
    start(count, &work, [](void* it, std::size_t task) { (*static_cast<std::remove_reference_t<Work>*>(it))(task); });
    takeTasks();
    finish();
  }

 private:
  using Call = void (*)(void*, std::size_t);

  void start(std::size_t count, void* work, Call call) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      work_ = work;
      call_ = call;
      count_ = count;
      next_ = 0;
      failure_ = nullptr;
      busy_ = others_.size();
      ++round_;
    }
    begin_.notify_all();
  }

  void takeTasks() {
    try {
      for (std::size_t task = next_++; task < count_; task = next_++) call_(work_, task);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = std::current_exception();
      next_ = count_;
    }
  }

  void finish() {
    std::unique_lock<std::mutex> lock(mutex_);
    end_.wait(lock, [this] { return busy_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
  }

  void serve() {
    for (std::size_t done = 0;;) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        begin_.wait(lock, [&] { return leaving_ || round_ != done; });
        if (leaving_) return;
        done = round_;
      }
      takeTasks();
      const std::lock_guard<std::mutex> lock(mutex_);
      if (--busy_ == 0) end_.notify_one();
    }
  }

  std::vector<std::thread> others_;
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  std::size_t round_ = 0, busy_ = 0;
  bool leaving_ = false;
  void* work_ = nullptr;
  Call call_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::exception_ptr failure_;
};

/// Calls `work(task)` for 0 <= task < count on `threads` threads that are started for this alone.
template <class Work>
void forEachTask(std::size_t count, int threads, Work&& work) {
  ThreadTeam(threads).forEach(count, work);
}

}  // namespace sas_motion
