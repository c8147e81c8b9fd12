// SPDX-License-Identifier: Apache-2.0
// kinfer simulate: INS log of a simulated machine with known truth.
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/cli/options/drive_choices.hpp"
#include "kinfer/cli/options/simulated_faults.hpp"
#include "kinfer/cli/parts/expected_cost.hpp"
#include "kinfer/cli/parts/run_record.hpp"
#include "kinfer/cli/parts/simulation_files.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/simulate/compliant_mounts.hpp"
#include "kinfer/simulate/four_bar_linkage.hpp"
#include "kinfer/simulate/ins_recording.hpp"
#include "kinfer/simulate/mujoco_world.hpp"

namespace kinfer::cli {
namespace {

struct SimulateArguments {
  CommonOptions common;
  std::string machine, out, base = "still", script = "standard", motion = "stiff", grade = "industrial";
  double slope = 0.0;  // deg
  bool arbitrary_mounting = false;
  int drive = 1;
  double duration = 0.0;  // s; 0: the script's default
  double sampling_rate = 200.0;
  SensorFaults trouble;
  bool no_magnetometer = false, linkage = false;
  SimulatedFaults faults;
  double accelerometer_range = 0.0, gyro_range = 0.0;  // g, deg/s; 0: the grade's
};

const std::map<std::string, Base> bases{{"still", Base::still}, {"rocking", Base::rocking}, {"yawing", Base::yawing}};

template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.push_back(name);
  return names;
}

MachineOptions machine_options(const SimulateArguments& options) {
  return {.mounting = options.arbitrary_mounting ? Mounting::arbitrary : Mounting::as_built,
          .base = bases.at(options.base),
          .slope = Angle::deg(options.slope)};
}

Result<SensorModel> sensor_model_of(const SimulateArguments& options) {
  SensorModel grade{.name = options.grade, .accelerometer = {}, .gyroscope = {}, .magnetometer = {}};
  if (options.grade != "perfect") {
    KINFER_TRY(known, read_grade(options.grade, "perfect"));
    grade = known;
  }
  if (options.accelerometer_range > 0.0) grade.accelerometer.range = options.accelerometer_range * standard_gravity;
  if (options.gyro_range > 0.0) grade.gyroscope.range = options.gyro_range * degree;
  return grade;
}

SensorFaults trouble_of(const SimulateArguments& options) {
  SensorFaults trouble = options.trouble;
  trouble.has_magnetometer = !options.no_magnetometer;
  return trouble;
}

Result<MachineMotion> move(const MujocoWorld& world, const Machine& machine, const Drive& drive,
                           const SimulateArguments& options) {
  if (options.linkage) return linkage_motion(machine, drive, options.sampling_rate);
  if (options.motion == "prescribed") return world.prescribe(drive, options.sampling_rate);
  return world.drive(drive, options.sampling_rate, options.motion == "soft" ? Servo::soft : Servo::stiff);
}

/// The machine's own draws for its first drive.
Rng of_drive(const Rng& rng, int drive) {
  return drive <= 1 ? rng : rng.stream(static_cast<std::uint64_t>(drive));
}

void print_summary(const SimulateArguments& options, const Machine& machine, const MachineMotion& motion) {
  const auto joints = dof(machine.chain) - machine.base_dof;
  const double seconds = static_cast<double>(motion.time.size()) / options.sampling_rate;
  if (options.common.json) {
    const nlohmann::ordered_json headline{
        {"machine", options.machine}, {"joints", joints},   {"sensors", machine.sensors.size()},
        {"rows", motion.time.size()}, {"seconds", seconds}, {"grade", options.grade}};
    print_data(dump_json(headline) + "\n");
  } else if (!options.common.quiet) {
    print_text(
        "{}: {} joints, {} sensors of grade {}, {:.1f} s at {} Hz in {}:\n"
        "imu.csv (what they measured), truth.json (what there is to find), motion.csv (how it moved), machine.xml "
        "(MJCF)\n",
        options.machine, joints, machine.sensors.size(), options.grade, seconds, options.sampling_rate, options.out);
  }
}

Result<void> simulate(const SimulateArguments& options) {
  const RunRecord run_record("simulate", options.common);
  const Rng rng(options.common.seed);
  KINFER_TRY(mjcf, machine_mjcf(options.machine, machine_options(options), rng.stream(1)));
  KINFER_TRY(sensors, sensor_model_of(options));
  KINFER_TRY(world, MujocoWorld::load(mjcf));
  if (options.linkage && !options.machine.starts_with("excavator"))
    return error("--linkage: only available for excavators");
  if (options.linkage && options.motion == "soft")
    return error("--motion soft: has no effect with --linkage, whose joints follow the drive exactly");
  const Machine machine = options.linkage ? with_linkage(world.machine()) : world.machine();
  KINFER_TRY(drive,
             make_drive(world.machine(), {.script = drive_scripts.at(options.script), .duration = options.duration},
                        of_drive(rng.stream(2), options.drive)));
  const double rows = drive.duration * options.sampling_rate, count = static_cast<double>(machine.sensors.size());
  if (auto possible = check_cost(cost_of_simulation(rows, count)); !possible) return possible;
  KINFER_TRY(folder, run_record.open_folder(options.out));
  KINFER_TRY(moved, move(world, machine, drive, options));
  const MachineTruth truth = machine_truth(machine, moved);
  if (options.faults.foam > 0.0)
    moved = with_foam_mounts(std::move(moved), options.faults.foam * degree, rng.stream(4));
  KINFER_TRY(motion, with_remount(machine, std::move(moved), options.faults));
  KINFER_TRY(punctual, with_late_sensor(simulate_recording(machine, motion, sensors, trouble_of(options), rng.stream(3),
                                                           static_cast<std::uint64_t>(options.drive)),
                                        options.faults));
  const InsRecording recording =
      with_stamp_faults(std::move(punctual), options.faults, of_drive(rng.stream(5), options.drive));
  const SimulationRecord record{options.machine,     sensors.name,  options.base,         options.slope,
                                options.common.seed, options.drive, options.sampling_rate};
  for (const auto& [name, text] :
       {std::pair{"imu.csv", imu_csv(recording)}, std::pair{"motion.csv", motion_csv(machine, motion)},
        std::pair{"truth.json", truth_json(record, drive, machine, truth)}, std::pair{"machine.xml", mjcf}})
    if (auto done = write_text_file(folder / name, text); !done) return done;
  if (auto done = run_record.write(folder); !done) return done;
  if (auto done = folder.commit(); !done) return done;
  print_summary(options, machine, motion);
  return {};
}

int run(const SimulateArguments& options) {
  const auto done = simulate(options);
  return done ? exit_done : fail(done.error());
}

void add_machine_options(CLI::App& verb, SimulateArguments& options) {
  begin_group(verb, "Machine");
  add_flag(verb, "--arbitrary-mounting", options.arbitrary_mounting,
           "Sensors in arbitrary mountings, joints with small errors (excavator-general always is)");
  add_choice(verb, "--base", options.base, names_of(bases),
             "rocking: it rolls, pitches and heaves; yawing: it also turns on its tracks");
  add_flag(verb, "--linkage", options.linkage,
           "A four-bar linkage about the excavator's bucket, an INS on each bar; its motion is prescribed");
  add_number(verb, "--slope", options.slope, 0.0, 45.0, "Slope of the ground [deg]");
}

void add_motion_options(CLI::App& verb, SimulateArguments& options) {
  begin_group(verb, "Motion");
  add_choice(verb, "--excitation", options.script, names_of(drive_scripts),
             "standard: 4 s rest, 6 s a joint, 16 s all; sequential: without 'all'; together: 30 s all; gentle and "
             "vigorous: standard at 45 and 180 %; quick: its waves four times as fast");
  add_count(verb, "--drive", options.drive, 1, 1000000,
            "Another drive of the same machine by the same sensors: 2, 3, ... have other motions and other noise");
  add_number(verb, "--duration", options.duration, 0.0, 3600.0, "Length of the recording [s]; 0: the script's own");
  add_choice(verb, "--motion", options.motion, {"stiff", "soft", "prescribed"},
             "stiff: forward dynamics, the joints follow; soft: they sway; prescribed: inverse dynamics");
  add_number(verb, "--rate", options.sampling_rate, 20.0, 2000.0, "Samples a second [Hz]");
}

void add_sensor_options(CLI::App& verb, SimulateArguments& options) {
  begin_group(verb, "Sensors and their faults");
  add_text(verb, "--grade", options.grade, "Sensor errors: perfect, noise, industrial, consumer or a data sheet",
           Requirement::optional, "NAME|TOML");
  add_number(verb, "--missing", options.trouble.missing, 0.0, 0.9, "Fraction of the samples that are lost");
  add_number(verb, "--spikes", options.trouble.spikes, 0.0, 1000.0, "Outliers per minute on each axis");
  add_number(verb, "--accelerometer-range", options.accelerometer_range, 0.0, 1000.0,
             "Clip at this many g; 0: the grade's");
  add_number(verb, "--gyro-range", options.gyro_range, 0.0, 1e5, "Saturate at this many deg/s; 0: the grade's");
  add_number(verb, "--magnetic-disturbance", options.trouble.magnetic_disturbance, 0.0, 1000.0,
             "Magnetic disturbance by moving steel [uT rms]");
  add_number(verb, "--hard-iron", options.trouble.hard_iron, 0.0, 1000.0,
             "Iron on each segment that carries a sensor: the size of its constant field at the magnetometer [uT]");
  add_number(verb, "--soft-iron", options.trouble.soft_iron, 0.0, 0.5,
             "Likewise, how much it distorts the Earth's field: 0.04 is 4 % an element of the symmetric matrix");
  add_number(verb, "--magnetic-transients", options.trouble.magnetic_transients, 0.0, 1000.0,
             "Steel that passes by two of the sensors: the peak of each passage of a few seconds [uT]");
  add_flag(verb, "--no-magnetometer", options.no_magnetometer, "Six axes only");
  add_number(verb, "--foam", options.faults.foam, 0.0, 30.0,
             "Sensors on foam: the mounts oscillate, and tilt by about this many degrees when mounted sideways; 0: "
             "rigid mounts");
  add_text(verb, "--late", options.faults.late, "This sensor's samples are logged this many ms late",
           Requirement::optional, "SENSOR=MS");
  add_number(verb, "--jitter", options.faults.jitter, 0.0, 1000.0,
             "Rows are stamped late by random times that scatter by this many ms (rms)");
  add_count(verb, "--packet", options.faults.packet, 1, 1000,
            "This many rows are stamped at once, when the last of them arrives");
  add_text(verb, "--remount", options.faults.remount,
           "This sensor is rotated by 21 degrees and shifted by 10 cm after this many seconds; truth.json describes "
           "the mounting before",
           Requirement::optional, "SENSOR=S");
}

}  // namespace

Verb add_simulate(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "simulate", "INS log of a simulated machine with known truth, to try things out",
                  "Examples:\n  kinfer simulate excavator --out data\n"
                  "  kinfer simulate crane --excitation gentle --grade consumer --slope 4 --seed 7 --out data\n"
                  "  kinfer simulate excavator-general --drive 2 --duration 120 --out later");
  auto options = std::make_shared<SimulateArguments>();
  add_text(*verb, "machine", options->machine, fmt::format("One of {}", fmt::join(machine_names(), ", ")),
           Requirement::required, "NAME");
  add_text(*verb, "--out", options->out, "Folder for imu.csv, truth.json, motion.csv, machine.xml, run.json",
           Requirement::required, "DIR");
  add_machine_options(*verb, *options);
  add_motion_options(*verb, *options);
  add_sensor_options(*verb, *options);
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
