// SPDX-License-Identifier: Apache-2.0
// kinfer sweep: many runs of other verbs, on all cores, resumable, in shards.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/cli/options/search_options.hpp"
#include "kinfer/cli/parts/arguments.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/sweep/sweep_folder.hpp"
#include "kinfer/cli/sweep/sweep_script.hpp"
#include "kinfer/cli/sweep/task_pool.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/text/replace_all.hpp"

namespace kinfer::cli {
namespace {

struct SweepArguments {
  std::string manifest, each, verb, arguments, out, shard, print, prior;
  int workers = 0, shards = 0;
  std::uint64_t seed = 1;
  bool resume = false, retry = false, pack = false, quiet = false;
};

struct Tally {
  int use = 0, do_not_use = 0, refused = 0, failed = 0, done_before = 0;
  int ended() const { return use + do_not_use + refused + failed; }
};

void count(const TaskRecord& result, Tally& tally) {
  if (result.signal != 0 || result.exit_code > exit_bad_input)
    ++tally.failed;
  else if (result.exit_code == exit_bad_input)
    ++tally.refused;
  else
    ++(result.exit_code == exit_done ? tally.use : tally.do_not_use);
}

/// The prior becomes an argument of the tasks, so that a resumed sweep cannot mix results with and without it.
Result<void> add_prior(const SweepArguments& options, const CLI::App& program, std::vector<SweepTask>& tasks) {
  if (options.prior.empty()) return {};
  bool has_effect = false;
  for (SweepTask& task : tasks) {
    if (!has_option(program, task.verb, "--prior") ||
        std::ranges::find(task.arguments, "--prior") != task.arguments.end())
      continue;
    task.arguments.insert(task.arguments.end(), {"--prior", options.prior});
    has_effect = true;
  }
  if (!has_effect) return error("--prior has no effect: no task without it is a calibration");
  return check_prior(options.prior);  // once, and not in each of ten thousand tasks
}

Result<std::vector<SweepTask>> read_tasks(const SweepArguments& options, const CLI::App& program) {
  if (options.manifest.empty() == options.each.empty()) return error("expected a manifest, or --each with --verb");
  if (!options.each.empty() && options.verb.empty()) return error("--each needs --verb");
  if (options.each.empty() && (!options.verb.empty() || !options.arguments.empty()))
    return error("--verb and --arguments have no effect with a manifest, whose rows state them");
  KINFER_TRY(tasks, options.each.empty() ? read_manifest(options.manifest)
                                         : tasks_of_files(options.each, options.verb, options.arguments));
  for (const SweepTask& task : tasks)
    if (!has_verb(program, task.verb) || task.verb == "sweep" || task.verb == "merge" || task.verb == "demo")
      return error("{}: \"{}\" is no verb that can be swept",
                   task.line > 0 ? fmt::format("{}:{}", options.manifest, task.line) : "--verb", task.verb);
  if (auto done = add_prior(options, program, tasks); !done) return forward_error(done.error());
  return tasks;
}

/// The words of the task's run: its arguments, and output folder, seed and one thread where the verb knows them and the
/// arguments do not give them.
std::vector<std::string> words_of(const SweepTask& task, std::uint64_t seed, const std::string& folder,
                                  const CLI::App& program) {
  std::vector<std::string> words{task.verb};
  bool names_folder = false;
  for (std::string word : task.arguments) {
    names_folder |= word.find("{out}") != std::string::npos;
    replace_all(word, "{out}", folder);
    replace_all(word, "{seed}", std::to_string(seed));
    words.push_back(std::move(word));
  }
  const auto add = [&](const std::string& option, const std::string& value) {
    const bool is_given = std::ranges::find(task.arguments, option) != task.arguments.end();
    if (!is_given && has_option(program, task.verb, option)) words.push_back(option), words.push_back(value);
  };
  const bool writes_file = has_option(program, task.verb, "-o");  // without it, to standard output: output.txt
  if (!names_folder && !writes_file) add("--out", folder);
  add("--seed", std::to_string(seed));
  add("--threads", "1");
  return words;
}

class SweepRun {
 public:
  SweepRun(const SweepArguments& options, const std::vector<SweepTask>& tasks, const Shard& shard, SweepFolder& folder,
           const CLI::App& program)
      : options_(options), tasks_(tasks), folder_(folder), program_(program), pool_(workers(options)) {
    for (std::size_t i = 0; i < tasks.size(); ++i)
      if (shard.has(i)) mine_.push_back(i);
  }

  Result<Tally> run() {
    for (const std::size_t i : mine_) {
      if (is_done(tasks_[i])) continue;
      while (pool_.is_full())
        if (auto done = wait(); !done) return forward_error(done.error());
      KINFER_TRY(folder, folder_.begin(tasks_[i]));
      const auto words = words_of(tasks_[i], seed_of(tasks_[i]), folder.string(), program_);
      if (!pool_.start(static_cast<int>(i), words, {folder, tasks_[i].truth}))
        return error("no process can be made for a task");
    }
    while (!pool_.is_empty())
      if (auto done = wait(); !done) return forward_error(done.error());
    if (shows_progress_) print_progress("");
    return tally_;
  }

 private:
  static int workers(const SweepArguments& options) {
    return options.workers > 0 ? options.workers : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }

  std::uint64_t seed_of(const SweepTask& task) const { return task_seed(options_.seed, task.key); }

  bool is_done(const SweepTask& task) {
    if (!folder_.is_done(task)) return false;
    const auto result = folder_.result_of(task);
    if (!result || (options_.retry && result->exit_code > exit_do_not_use)) {
      folder_.discard(task);
      return false;
    }
    count(*result, tally_);
    ++tally_.done_before;
    return true;
  }

  Result<void> wait() {
    const EndedTask ended = pool_.wait();
    const SweepTask& task = tasks_[static_cast<std::size_t>(ended.task)];
    KINFER_TRY(result, folder_.end(task, seed_of(task), ended.exit_code, ended.signal));
    count(result, tally_);
    if (!result.sentence.empty() && !options_.quiet) {
      if (shows_progress_) print_progress("");
      print_message("{}: {}\n", task.key, result.sentence);
    }
    show_progress();
    return {};
  }

  void show_progress() {
    if (!shows_progress_) return;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    const int before = tally_.done_before, now = tally_.ended() - before;
    const double left = static_cast<double>(mine_.size()) - before;
    print_progress(fmt::format("{} of {} tasks{}", tally_.ended(), mine_.size(), time_left(seconds, now / left)));
  }

  const SweepArguments& options_;
  const std::vector<SweepTask>& tasks_;
  SweepFolder& folder_;
  const CLI::App& program_;
  TaskPool pool_;
  std::vector<std::size_t> mine_;
  Tally tally_;
  bool shows_progress_ = !options_.quiet && isatty(fileno(stderr)) != 0;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

std::string shell_word(const std::string& word) {
  const bool is_plain = !word.empty() && word.find_first_not_of(
                                             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                             "0123456789._-/=+:@%") == std::string::npos;
  return is_plain ? word : "\"" + word + "\"";
}

int print_script(const SweepArguments& options, std::size_t tasks) {
  const int shards = options.shards > 0 ? options.shards : static_cast<int>(std::min<std::size_t>(tasks, 8));
  const InstructionSet kernels = instruction_set();
  std::string command =
      kernels == widest_instruction_set() ? "kinfer sweep" : fmt::format("kinfer --kernels {} sweep", name(kernels));
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) command += (name.empty() ? "" : " " + name) + " " + shell_word(value);
  };
  add("", options.manifest), add("--each", options.each), add("--verb", options.verb);
  add("--arguments", options.arguments), add("--prior", options.prior), add("--out", options.out),
      add("--seed", std::to_string(options.seed));
  if (options.pack) command += " --pack";
  print_data(sweep_script(options.print, command + " --resume --quiet", shards));
  return exit_done;
}

int run(const SweepArguments& options, const CLI::App& program) {
  const auto tasks = read_tasks(options, program);
  if (!tasks) return fail(tasks.error());
  if (!options.print.empty()) return print_script(options, tasks->size());
  if (options.shards > 0) return fail({"--shards has no effect without --print"});
  const auto shard = options.shard.empty() ? Result<Shard>(Shard{}) : parse_shard(options.shard);
  if (!shard) return fail(shard.error());
  // Shards begin in any order, so none of them can know whether it is the first.
  auto folder = SweepFolder::open(options.out, *tasks, *shard, options.resume || options.retry || shard->parts > 1,
                                  options.pack ? ResultStorage::archive : ResultStorage::folders);
  if (!folder) return fail(folder.error());
  const auto tally = SweepRun(options, *tasks, *shard, *folder, program).run();
  if (!tally) return fail(tally.error());
  if (!options.quiet)
    print_text("{} tasks: {} use, {} do not use, {} refused, {} failed{}\n", tally->ended(), tally->use,
               tally->do_not_use, tally->refused, tally->failed,
               tally->done_before > 0 ? fmt::format(" ({} were done before)", tally->done_before) : "");
  return exit_done;
}

}  // namespace

Verb add_sweep(CLI::App& app) {
  CLI::App* verb = add_command(
      app, "sweep", "Run a verb for many machines, logs or seeds: one task a row of a manifest",
      "Each task has a folder of its own below --out, renamed when it is complete: what exists is done. Seeds come "
      "from\n"
      "--seed and the task's key, never from the order. Example:\n"
      "  kinfer sweep --each 'robots/*/poses.csv' --verb calibrate --arguments '--robot {folder}/robot.toml --data "
      "{file}' --out runs\n  kinfer sweep manifest.csv --out runs --print slurm --shards 100 > job.sh");
  auto options = std::make_shared<SweepArguments>();
  add_text(*verb, "manifest", options->manifest, "Tasks: columns key, verb, arguments", Requirement::optional, "CSV");
  add_text(*verb, "--each", options->each, "Instead: a task for each file that matches", Requirement::optional,
           "PATTERN");
  add_text(*verb, "--verb", options->verb, "With --each: the verb", Requirement::optional, "VERB");
  add_text(*verb, "--arguments", options->arguments, "With --each: its arguments; {file}, {folder}, {out}, {seed}",
           Requirement::optional, "WORDS");
  add_text(*verb, "--prior", options->prior,
           "Folder of `kinfer merge`: its population is the prior of each calibration", Requirement::optional, "FLEET");
  add_text(*verb, "--out", options->out, "Folder of all tasks' folders", Requirement::required, "DIR");
  add_flag(*verb, "--resume", options->resume, "Go on with a sweep that was interrupted");
  add_flag(*verb, "--retry", options->retry, "Go on, and run tasks again that were refused or failed");
  add_text(*verb, "--shard", options->shard, "Only part i of N of the tasks", Requirement::optional, "i/N");
  add_flag(*verb, "--pack", options->pack,
           "Results of all tasks in one archive (a shard's own), for file systems that many small files wear down; "
           "tasks run below TMPDIR");
  add_count(*verb, "--workers", options->workers, 0, 1024, "Tasks at once, each with one thread; 0: one a core");
  add_seed(*verb, "--seed", options->seed, "Seed from which each task's own is made");
  add_choice(*verb, "--print", options->print, engine_names(), "Print a job file for an engine, and run nothing");
  add_count(*verb, "--shards", options->shards, 0, 1000000, "With --print: into how many parts; 0: up to 8");
  add_quiet_option(*verb, options->quiet);
  return {verb, [options, program = &app] { return run(*options, *program); }};
}

}  // namespace kinfer::cli
