// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace sas_motion {

/// Computes `work(task)` for first <= task < last on `jobs` threads and hands the results to `use` in the order of the
/// tasks, each as soon as its turn comes. A thread that is far ahead waits, so that few results are held. What `work`
/// or `use` throws reaches the caller.
template <class Work, class Use>
void inOrder(std::size_t first, std::size_t last, int jobs, Work&& work, Use&& use) {
  using Result = decltype(work(first));
  const std::size_t ahead = 16 * static_cast<std::size_t>(jobs);
  std::size_t next = first, turn = first;
  std::map<std::size_t, Result> done;
  std::exception_ptr failure;
  std::mutex mutex;
  std::condition_variable moved;
  const auto loop = [&] {
    std::unique_lock<std::mutex> lock(mutex);
    try {
      while (true) {
        moved.wait(lock, [&] { return failure || next == last || next < turn + ahead; });
        if (failure || next == last) return;
        const std::size_t task = next++;
        lock.unlock();
        Result result = work(task);
        lock.lock();
        done.emplace(task, std::move(result));
        for (auto ready = done.find(turn); ready != done.end() && !failure; ready = done.find(turn)) {
          use(ready->second);
          done.erase(ready);
          ++turn;
        }
        moved.notify_all();
      }
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      failure = std::current_exception();
      moved.notify_all();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(jobs));
  try {
    for (int i = 0; i < jobs; ++i) threads.emplace_back(loop);
  } catch (...) {  // a thread that cannot start ends those that did
    const std::lock_guard<std::mutex> lock(mutex);
    failure = std::current_exception();
    moved.notify_all();
  }
  for (auto& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sas_motion
