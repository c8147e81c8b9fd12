// SPDX-License-Identifier: Apache-2.0
// Help texts, man pages, completions, spelling suggestions and the demo, through the program.
#include <gmock/gmock.h>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using testing::HasSubstr;

class Help : public Program {
 protected:
  std::vector<std::string> verbs() const {
    std::istringstream lines(kinfer("--help").out);
    std::vector<std::string> names;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
      if (line == "Verbs:") inside = true;
      if (line == "Options:") inside = false;
      if (inside && line.starts_with("  ") && line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    return names;
  }

  /// Exit code of a shell command in the test's folder.
  int shell(const std::string& command) const {
    return WEXITSTATUS(std::system(("cd '" + folder_.string() + "' && " + command + " >shell.txt 2>&1").c_str()));
  }
};

TEST_F(Help, OptionsAreInGroupsWithDefaultsAndAnExample) {
  const std::string help = kinfer("calibrate --help").out;
  EXPECT_THAT(help, HasSubstr("Usage: kinfer calibrate --robot FILE --out DIR [OPTIONS]"));
  for (const char* heading :
       {"\nRequired:\n", "\nRobot file:\n", "\nModel:\n", "\nValidation:\n", "\nOutput and repeatability:\n"})
    EXPECT_THAT(help, HasSubstr(heading));
  EXPECT_THAT(help, HasSubstr("--offsets folded|separate"));
  EXPECT_THAT(help, HasSubstr("[folded]"));
  EXPECT_THAT(help, HasSubstr("Example:\n  kinfer calibrate "));
  EXPECT_LT(help.find("\nRequired:"), help.find("\nOutput and repeatability:"));
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.starts_with("  kinfer") || line.size() <= 110u) << line;
}

TEST_F(Help, WithoutAVerbTheVerbsAreListed) {
  const Outcome run = kinfer("");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("\nVerbs:\n"));
}

TEST_F(Help, EveryVerbHasAnExampleAManPageAndCompletion) {
  ASSERT_GT(verbs().size(), 15u);
  const std::string bash = kinfer("completion bash").out;
  ASSERT_EQ(kinfer("man --out pages").code, 0);
  for (const std::string& verb : verbs()) {
    EXPECT_THAT(kinfer(verb + " --help").out, HasSubstr("Example")) << verb;
    EXPECT_THAT(bash, HasSubstr("\n    " + verb + ")\n"));
    const std::string page = slurp(in("pages/kinfer-" + verb + ".1"));
    for (const char* section : {".TH ", ".SH NAME\n", ".SH SYNOPSIS\n", ".SH OPTIONS\n", ".SH EXAMPLES\n"})
      EXPECT_THAT(page, HasSubstr(section)) << verb;
    EXPECT_EQ(page, kinfer("man " + verb).out);
  }
  EXPECT_THAT(slurp(in("pages/kinfer.1")), HasSubstr(".BR kinfer\\-identify (1)"));
  if (shell("which groff") == 0) {
    EXPECT_EQ(shell("for p in pages/*; do groff -man -Tutf8 -ww -z $p; done; test ! -s shell.txt"), 0)
        << slurp(in("shell.txt"));
  }
}

TEST_F(Help, BashCompletesVerbsOptionsChoicesAndFiles) {
  write(in("kinfer.bash"), kinfer("completion bash").out);
  write(in("poses.csv"), "");
  write(in("ask.bash"),
        "source kinfer.bash\ncompopt() { :; }\n"
        "ask() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); _kinfer; echo \"${COMPREPLY[*]}\"; }\n"
        "ask kinfer cal\nask kinfer calibrate --ref\nask kinfer calibrate --method q\n"
        "ask kinfer calibrate --data po\nask kinfer inspect po\n");
  EXPECT_EQ(shell("bash ask.bash"), 0);
  EXPECT_EQ(slurp(in("shell.txt")), "calibrate\n--refit\nqpso\nposes.csv\nposes.csv\n");
}

TEST_F(Help, OtherShellsAcceptTheirScripts) {
  write(in("_kinfer"), kinfer("completion zsh").out);
  write(in("kinfer.fish"), kinfer("completion fish").out);
  EXPECT_THAT(slurp(in("_kinfer")), HasSubstr("#compdef kinfer\n"));
  EXPECT_THAT(slurp(in("kinfer.fish")), HasSubstr("-n '__fish_seen_subcommand_from calibrate' -l robot -r -F"));
  EXPECT_TRUE(shell("which zsh") != 0 || shell("zsh -n _kinfer") == 0) << slurp(in("shell.txt"));
  EXPECT_TRUE(shell("which fish") != 0 || shell("fish -n kinfer.fish") == 0) << slurp(in("shell.txt"));
}

TEST_F(Help, MisspeltWordsGetTheNearestOne) {
  struct Case {
    const char *arguments, *sentence;
  };
  const Case cases[] = {
      {"calibrat", "kinfer: there is no verb \"calibrat\"; did you mean calibrate?\n"},
      {"idnetify log.csv", "kinfer: there is no verb \"idnetify\"; did you mean identify?\n"},
      {"frobnicate", "kinfer: there is no verb \"frobnicate\"\n"},
      {"calibrate --dat p.csv", "kinfer: calibrate: there is no option --dat; did you mean --data?\n"},
      {"calibrate --robt=r.toml", "kinfer: calibrate: there is no option --robt; did you mean --robot?\n"},
      {"--langage names identify", "kinfer: there is no option --langage; did you mean --language?\n"},
      {"plan --zzzzzz 3", "kinfer: plan: there is no option --zzzzzz\n"},
  };
  for (const Case& misspelt : cases) {
    const Outcome run = kinfer(misspelt.arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr(misspelt.sentence));
  }
  EXPECT_EQ(kinfer("--language names --version").code, 0);
}

TEST_F(Help, TheDemoIdentifiesAndCalibrates) {
  const Outcome run = kinfer("demo");
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* file :
       {"excavator/report.html", "excavator/chain.toml", "calibration/report.html", "data/poses.csv"})
    EXPECT_TRUE(fs::exists(in("kinfer-demo") / file)) << file;
  EXPECT_THAT(run.err, HasSubstr("$ kinfer identify kinfer-demo/drive/imu.csv --out kinfer-demo/excavator\n"));
  EXPECT_THAT(slurp(in("kinfer-demo/excavator/run.json")), HasSubstr("\"identify\""));
  const Outcome again = kinfer("demo");
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("kinfer-demo: expected a new or an empty folder"));
}

}  // namespace
}  // namespace kinfer::test
