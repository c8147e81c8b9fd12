// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/chain_recordings.hpp"

#include <gmock/gmock.h>

#include "kinfer/io/evidence/identification_json.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::test {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> names_of(const std::vector<InputFile>& files) {
  std::vector<std::string> names;
  for (const InputFile& file : files) names.push_back(file.name);
  return names;
}

TEST(AllInputs, AreThoseOfEarlierIdentificationsToo) {
  const std::vector<InputFile> inputs{{"third.csv", "3"}, {"chain.toml", "c"}, {"track.toml", "t"}},
      earlier{{"first.csv", "1"}, {"second.csv", "2"}};
  EXPECT_THAT(names_of(all_inputs(inputs, earlier)), ElementsAre("first.csv", "second.csv", "third.csv"));
}

TEST(AllInputs, AreReadBackAsTheyWereWritten) {
  Provenance provenance = rich_provenance();
  provenance.earlier_inputs = {{"first.csv", std::string(64, 'c')}};
  const auto written = identification_evidence(rich_identification(), provenance);
  const auto read = read_identification_evidence(format_identification_evidence(written));
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(names_of(read->provenance.earlier_inputs), ElementsAre("first.csv"));
  const auto plain = format_identification_evidence(identification_evidence(rich_identification(), rich_provenance()));
  EXPECT_EQ(plain.find("earlier_inputs"), std::string::npos) << "files of what updates nothing are as before";
  EXPECT_TRUE(read_identification_evidence(plain));
}

}  // namespace
}  // namespace kinfer::test
