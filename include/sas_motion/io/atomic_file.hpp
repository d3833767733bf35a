// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace sas_motion {

/// A file that appears under its name only when it is complete: it is written under a temporary name in the same
/// folder, flushed to disk and renamed. Without commit() the destructor removes it, and an older file stays as it was.
class AtomicFile {
 public:
  /// Throws std::runtime_error naming the file where its folder cannot be written.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The path to write to.
  const std::string& temporary() const { return temporary_; }
  /// Throws std::runtime_error naming the file where the disk is full or fails.
  void commit();

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

/// Writes a whole text file atomically.
void writeFile(const std::string& path, const std::string& text);

/// Makes a folder and its parents. Throws std::runtime_error naming it.
void makeFolder(const std::string& path);

}  // namespace sas_motion
