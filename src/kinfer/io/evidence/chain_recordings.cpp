// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/chain_recordings.hpp"

#include <algorithm>
#include <iterator>
#include <variant>

#include "kinfer/io/evidence/evidence_file.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/text/text_file.hpp"
#include "kinfer/io/tracking/tracked_chain.hpp"

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

Result<void> expect_new_recordings(const std::vector<std::string>& logs, const std::vector<InputFile>& earlier,
                                   const std::string& chain) {
  if (earlier.empty()) return {};
  for (const InputFile& log : fingerprints(logs))
    if (std::ranges::find(earlier, log.sha256, &InputFile::sha256) != earlier.end())
      return error("{}: {} was identified from this recording, which would count twice; --update needs a new one",
                   log.name, chain);
  return {};
}

}  // namespace kinfer
