// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/chain_recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <variant>

#include "kinfer/io/evidence/evidence_file.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/tracking/tracked_chain.hpp"
#include "kinfer/measurement/ins/sample_digest.hpp"

namespace kinfer {

std::vector<InputFile> all_inputs(const std::vector<InputFile>& inputs, const std::vector<InputFile>& earlier) {
  std::vector<InputFile> all = earlier;
  std::ranges::copy_if(inputs, std::back_inserter(all),
                       [](const InputFile& input) { return input.name != "chain.toml" && input.name != "track.toml"; });
  return all;
}

std::vector<InputFile> recordings_of_chain(const std::string& chain) {
  const auto text = read_text_file((ChainFiles(chain).chain.parent_path() / "evidence.json").string());
  if (!text) return {};
  const auto evidence = read_evidence(*text);
  const auto* known = evidence ? std::get_if<IdentificationEvidence>(&*evidence) : nullptr;
  return known ? all_inputs(known->provenance.inputs, known->provenance.earlier_inputs) : std::vector<InputFile>{};
}

std::vector<InputFile> with_samples(std::vector<InputFile> logs, const InsRecording& recording) {
  if (!logs.empty()) logs.front().samples = sample_digest(recording);
  return logs;
}

Result<void> expect_new_recordings(const std::vector<std::string>& logs, const InsRecording& recording,
                                   const std::vector<InputFile>& earlier, const std::string& chain) {
  if (earlier.empty()) return {};
  for (const InputFile& log : fingerprints(logs))
    if (std::ranges::find(earlier, log.sha256, &InputFile::sha256) != earlier.end())
      return error("{}: {} was identified from this recording, which would count twice; --update needs a new one",
                   log.name, chain);
  const std::string samples = sample_digest(recording);
  for (const InputFile& before : earlier)
    if (const double share = shared_samples(samples, before.samples); share > 0.0)
      return error(
          "{}: {} was identified from {}, which holds {} of the same measurements; they would count twice, and "
          "--update "
          "needs a new recording",
          logs.empty() ? "the recording" : logs.front(), chain, before.name,
          share > 0.995 ? "all" : fmt::format("{:.0f} %", std::max(1.0, 100.0 * share)));
  return {};
}

}  // namespace kinfer
