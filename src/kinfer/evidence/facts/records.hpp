// SPDX-License-Identifier: Apache-2.0
// What every evidence.json holds: facts together with the sentences made of them. The file is the whole interface
// between a run and its report, so the sentences are stored, and read back as they were written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/evidence/facts/provenance.hpp"
#include "kinfer/evidence/facts/verdict.hpp"

namespace kinfer {

struct VerdictRecord {
  std::string sentence{};
  Usability usability = Usability::use_with_care;
  std::optional<VerdictText> parts{};  ///< of the sentence; none in files of earlier versions
};

struct FindingRecord {
  Finding finding{};  ///< without equivalents
  std::string sentence{}, suggestion{};
};

struct ProvenanceRecord {
  std::string version{};  ///< of the kinfer that wrote the file
  std::uint64_t seed = 1;
  std::vector<std::pair<std::string, std::string>> options{};  ///< in the order of the file
  std::vector<InputFile> inputs{};
  std::vector<InputFile> earlier_inputs{};  ///< as of Provenance
};

}  // namespace kinfer
