// kinfer report: makes report.html again from evidence.json.
#include "kinfer/report/report.hpp"

#include <memory>

#include "kinfer/cli/report_file.hpp"
#include "kinfer/cli/verbs.hpp"
#include "kinfer/io/text_file.hpp"

namespace kinfer::cli {
namespace {

Result<void> write_report(const std::filesystem::path& folder, const std::string& evidence) {
  KINFER_TRY(page, report_html(evidence));
  return write_text_file(folder / "report.html", page);
}

int run(const std::string& folder) {
  const auto evidence = read_text_file(std::filesystem::path(folder) / "evidence.json");
  if (!evidence) return fail(evidence.error());
  if (auto done = write_report(folder, *evidence); !done) return fail(done.error());
  return exit_done;
}

}  // namespace

Result<void> write_evidence(const std::filesystem::path& folder, const std::string& evidence) {
  if (auto done = write_text_file(folder / "evidence.json", evidence); !done) return done;
  // The result stands on evidence.json; a report that cannot be made of it takes nothing away.
  if (auto done = write_report(folder, evidence); !done)
    fmt::print(stderr, "kinfer: report.html was not written: {}\n", done.error().what);
  return {};
}

Verb add_report(CLI::App& app) {
  CLI::App* verb = add_command(app, "report", "Make DIR/report.html again from DIR/evidence.json",
                               "calibrate and identify write the report themselves.\nExample:\n"
                               "  kinfer report calibration");
  auto folder = std::make_shared<std::string>();
  add_text(*verb, "folder", *folder, "Folder with evidence.json", Need::required, "DIR");
  return {verb, [folder] { return run(*folder); }};
}

}  // namespace kinfer::cli
