// SPDX-License-Identifier: Apache-2.0
// Folder of a run's results: all of them or none. They are written into a hidden folder beside it, which takes its
// place in one step when they are complete; so whoever looks, or kills the run, finds the old results or the new ones.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/base/temporary_paths.hpp"

namespace kinfer::cli {

class OutputFolder {
 public:
  /// Created where it is absent, checked to be writable, and locked: an error where another run writes into it. The
  /// system releases the lock when the process ends, however it ends.
  static Result<OutputFolder> make(const std::filesystem::path& path);
  /// Removes what was not committed, and the folder if this run made it and it is empty.
  ~OutputFolder();
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;

  /// Where to write the file of this name.
  std::filesystem::path operator/(const std::string& name);
  /// Where files of a run that has no end appear at once (`track --follow`).
  std::filesystem::path visible(const std::string& name);

  /// Of the results so far.
  const std::vector<std::string>& names() const { return names_; }
  const std::filesystem::path& path() const { return path_; }

  /// Removes this file, a result of an earlier run that this one does not renew, when the results are put in place.
  void drop(const std::string& name) { dropped_.push_back(name); }

  /// Puts the results in place. Files of other names in the folder stay.
  Result<void> commit();

 private:
  OutputFolder(std::filesystem::path path, std::vector<std::filesystem::path> made)
      : path_(std::move(path)), made_(std::move(made)) {}
  Result<void> lock();
  Result<void> make_staging();
  bool replace_whole() const;
  Result<void> replace_one_by_one() const;

  std::filesystem::path path_, staging_;
  std::vector<std::filesystem::path> made_;  ///< folders that did not exist before, innermost first
  std::vector<TemporaryPath> temporary_;     ///< in the order in which they were made
  std::vector<std::string> names_;           ///< of the results
  std::vector<std::string> dropped_;         ///< of earlier results
  int lock_ = -1;
};

}  // namespace kinfer::cli
