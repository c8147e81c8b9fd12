// SPDX-License-Identifier: Apache-2.0
// The recordings that went into an identified chain, as the evidence.json beside it remembers them.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/facts/provenance.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

/// What went into a result and into the identifications that it updates, oldest first. The files of their chains are
/// left out: what they hold is in the others.
std::vector<InputFile> all_inputs(const std::vector<InputFile>& inputs, const std::vector<InputFile>& earlier);

/// With those of the chains that it updated. `chain`: as of ChainFiles. Empty where evidence.json no longer lies beside
/// it: nothing is known then.
std::vector<InputFile> recordings_of_chain(const std::string& chain);

/// The files, the first of which remembers what their recording holds.
std::vector<InputFile> with_samples(std::vector<InputFile> logs, const InsRecording& recording);

/// An error where one of the files `logs` is among `earlier`, the recordings of `chain`, or where their recording holds
/// samples of one of them: they would count twice.
Result<void> expect_new_recordings(const std::vector<std::string>& logs, const InsRecording& recording,
                                   const std::vector<InputFile>& earlier, const std::string& chain);

}  // namespace kinfer
