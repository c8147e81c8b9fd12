// SPDX-License-Identifier: Apache-2.0
// The program does nothing to a result that the library does not.
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "kinfer/base/sha256.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/measurement/ins/sample_digest.hpp"

namespace kinfer {
namespace {

using test::slurp;

class IdentifyLibrary : public test::Program {};

TEST_F(IdentifyLibrary, GivesTheBytesOfTheProgramsEvidence) {
  ASSERT_EQ(kinfer("simulate excavator --excitation together --out drive --grade noise --quiet").code, 0);
  ASSERT_EQ(kinfer("identify drive/imu.csv --engine bp --generations 3 --individuals 10 --links 2 --sensors "
                   "ins0,ins1,ins2 --seed 5 --out out --quiet")
                .code,
            0);
  identify::BacterialProgramming engine;
  engine.bacteria.generations = 3;
  engine.bacteria.individuals = 10;
  const identify::IdentifyOptions options{.engine = engine, .sensors = {"ins0", "ins1", "ins2"}, .links = 2};
  const auto recording = read_ins_csv(in("drive") / "imu.csv");
  ASSERT_TRUE(recording) << recording.error().what;
  const auto found = identify::identify_machine(*recording, options, Rng(5));
  ASSERT_TRUE(found) << found.error().what;
  const Provenance provenance{.inputs = {{.name = "imu.csv",
                                          .sha256 = *sha256_of_file(in("drive") / "imu.csv"),
                                          .samples = sample_digest(*recording)}},
                              .options = identify::describe(options),
                              .seed = 5};
  EXPECT_EQ(slurp(in("out") / "evidence.json"),
            format_identification_evidence(identification_evidence(*found, provenance)));
}

}  // namespace
}  // namespace kinfer
