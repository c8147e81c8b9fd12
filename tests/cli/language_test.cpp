// SPDX-License-Identifier: Apache-2.0
// No decision looks into a sentence: with every sentence replaced by its name, results, exit codes, colours and
// pictures stay the same.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer {
namespace {

using nlohmann::json;
using test::Outcome;
using test::slurp;

/// The evidence without the texts that `words` makes: a text with a space, or one that the other language has as a
/// name.
void drop_texts(json& a, json& b) {
  if (a.is_string() && b.is_string()) {
    if (a != b) a = b = "";
  } else if (a.is_structured() && b.is_structured() && a.size() == b.size()) {
    for (auto i = a.begin(), k = b.begin(); i != a.end(); ++i, ++k) drop_texts(*i, *k);
  }
}

/// Every piece of a text that starts with `start`, up to the next `end`. (std::regex recurses once per character.)
std::vector<std::string> pieces(const std::string& text, const std::string& start, char end) {
  std::vector<std::string> found;
  for (auto at = text.find(start); at != std::string::npos; at = text.find(start, at + 1))
    found.push_back(text.substr(at, text.find(end, at + start.size()) - at));
  return found;
}

class Language : public test::Program {
 protected:
  /// Runs a verb in both languages and compares what it leaves behind.
  void compare(const std::string& verb, const std::string& arguments) const {
    const Outcome english = kinfer(verb + " " + arguments + " --out english");
    const Outcome names = kinfer("--language names " + verb + " " + arguments + " --out names");
    EXPECT_EQ(names.code, english.code) << english.err << names.err;
    json a = json::parse(slurp(in("english/evidence.json"))), b = json::parse(slurp(in("names/evidence.json")));
    EXPECT_NE(a["verdict"], b["verdict"]);
    EXPECT_EQ(b["verdict"].get<std::string>().find(' '), std::string::npos) << b["verdict"];
    EXPECT_EQ(a["usability"], b["usability"]);
    drop_texts(a, b);
    EXPECT_EQ(a, b);
    for (const char* file : {"chain.toml", "chain.urdf"})
      EXPECT_EQ(slurp(in(std::string("english/") + file)), slurp(in(std::string("names/") + file))) << file;
    const std::string shown = slurp(in("english/report.html")), named = slurp(in("names/report.html"));
    EXPECT_EQ(pieces(shown, "class=\"chip ", '"'), pieces(named, "class=\"chip ", '"'));
    EXPECT_FALSE(pieces(shown, "<path", '>').empty());
    for (const char* element : {"<svg", "<circle", "<path", "<rect", "<polyline"})
      EXPECT_EQ(pieces(shown, element, '>'), pieces(named, element, '>')) << element;
  }
};

TEST_F(Language, ACalibrationIsTheSameWithoutItsSentences) {
  simulate();
  compare("calibrate", "--robot data/robot.toml --data data/poses.csv");
}

TEST_F(Language, ACalibrationWithFindingsThatIsNotUsableIsTheSameWithoutItsSentences) {
  simulate("--poses 12 --sigma 3");
  compare("calibrate", "--robot data/robot.toml --data data/poses.csv");
}

TEST_F(Language, AnIdentificationIsTheSameWithoutItsSentences) {
  ASSERT_EQ(kinfer("simulate excavator-general --excitation together --out drive --seed 3").code, 0);
  compare("identify", "drive/imu.csv");
}

TEST_F(Language, AnIdentificationWithFindingsIsTheSameWithoutItsSentences) {
  ASSERT_EQ(kinfer("simulate excavator --linkage --late ins2=40 --excitation together --out drive --seed 6").code, 0);
  compare("identify", "drive/imu.csv");
}

}  // namespace
}  // namespace kinfer
