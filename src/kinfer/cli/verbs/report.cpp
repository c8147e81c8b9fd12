// SPDX-License-Identifier: Apache-2.0
// kinfer report: regenerates report.html from evidence.json.
#include "kinfer/report/report.hpp"

#include <memory>

#include "kinfer/cli/parts/evidence_files.hpp"
#include "kinfer/cli/parts/output_folder.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/evidence_schema.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/evidence/track_json.hpp"
#include "kinfer/io/files/text_file.hpp"

namespace kinfer::cli {
namespace {

struct ReportArguments {
  std::string folder;
  bool schema = false, quiet = false;
};

int run(const ReportArguments& options) {
  if (options.schema == !options.folder.empty())
    return fail(Error{"expected a folder with evidence.json, or --schema"});
  if (options.schema) return print_data(format_evidence_schema()), exit_done;
  const std::filesystem::path folder = options.folder;
  const auto evidence = read_text_file(folder / "evidence.json");
  if (!evidence) return fail(evidence.error());
  const auto page = report::report_of_file(*evidence);
  if (!page) return fail(page.error());
  if (auto done = write_text_file(folder / "report.html", *page); !done) return fail(done.error());
  if (!options.quiet) print_text("{}\n", (folder / "report.html").string());
  return exit_done;
}

}  // namespace

Result<void> write_evidence(OutputFolder& folder, const CalibrationEvidence& evidence) {
  if (auto done = write_text_file(folder / "evidence.json", format_calibration_evidence(evidence)); !done) return done;
  return write_text_file(folder / "report.html", report::report_html(evidence));
}

Result<void> write_evidence(OutputFolder& folder, const IdentificationEvidence& evidence) {
  if (auto done = write_text_file(folder / "evidence.json", format_identification_evidence(evidence)); !done)
    return done;
  return write_text_file(folder / "report.html", report::report_html(evidence));
}

Result<void> write_evidence(OutputFolder& folder, const TrackRun& run) {
  if (auto done = write_text_file(folder / "evidence.json", format_track_run(run)); !done) return done;
  return write_text_file(folder / "report.html", report::report_html(run));
}

Verb add_report(CLI::App& app) {
  CLI::App* verb = add_command(app, "report", "Make DIR/report.html again from DIR/evidence.json",
                               "calibrate, identify and track write the report themselves.\nExample:\n"
                               "  kinfer report calibration\n  kinfer report --schema > evidence.schema.json");
  auto options = std::make_shared<ReportArguments>();
  add_text(*verb, "folder", options->folder, "Folder with evidence.json", Requirement::optional, "DIR");
  add_flag(*verb, "--schema", options->schema, "Print the JSON Schema of evidence.json instead");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
