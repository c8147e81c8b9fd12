// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/mujoco_world.hpp"

#include <cmath>
#include <cstring>
#include <mutex>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/simulate/mujoco_library.hpp"

namespace kinfer {
namespace {

constexpr double stiff_step = 1e-3;    // [s] of the integrator, at most
constexpr double soft_step = 2.5e-4;   // [s]: springs between unequal masses oscillate faster than computed torques
constexpr double settling_time = 2.0;  // [s] before the first row
constexpr const char* file_name = "machine.xml";

struct Deleter {
  void operator()(mjModel* model) const { mujoco().mj_deleteModel(model); }
  void operator()(mjData* data) const { mujoco().mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, Deleter>;
using Data = std::unique_ptr<mjData, Deleter>;

Vec3 vec3(const mjtNum* v) {
  return {v[0], v[1], v[2]};
}
Quat quat(const mjtNum* q) {
  return {q[0], q[1], q[2], q[3]};
}
Pose pose(const mjtNum* position, const mjtNum* orientation) {
  return {quat(orientation).normalized().toRotationMatrix(), vec3(position)};
}

/// Joint controller that tracks the drive, for the engine's callback.
struct Controller {
  const Drive* drive;
  Servo servo;
  VectorXd inertia;  ///< about each joint at home
  mutable VectorXd torque{};

  void apply_torques(const mjModel* model, mjData* data) const {
    const Eigen::Index n = inertia.size();
    const double omega = 2.0 * std::numbers::pi * (servo == Servo::stiff ? 10.0 : 2.5);
    VectorXd wanted(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const JointState state = state_at(drive->joints[static_cast<std::size_t>(k)], data->time);
      wanted[k] = omega * omega * (state.q - data->qpos[k]) + 2.0 * 0.7 * omega * (state.qd - data->qvel[k]);
      if (servo == Servo::stiff) wanted[k] += state.qdd;
    }
    torque = inertia.cwiseProduct(wanted);
    if (servo == Servo::stiff) mujoco().mj_mulM(model, data, torque.data(), wanted.data());
    for (Eigen::Index k = 0; k < n; ++k) data->qfrc_applied[k] = torque[k] + data->qfrc_bias[k];
  }
};

/// The engine has one callback per process, so the active controller is kept per thread.
thread_local const Controller* active_controller = nullptr;

void control_callback(const mjModel* model, mjData* data) {
  if (active_controller) active_controller->apply_torques(model, data);
}

void install_callbacks() {
  static std::once_flag once;
  std::call_once(once, [] {
    *mujoco().mjcb_control = control_callback;
    *mujoco().mju_user_warning = [](const char*) {
    };  // the default handler writes a log file into the working directory
  });
}

Link joint_link(const mjModel& model, int body, int joint, bool first) {
  const Pose at = first ? pose(model.body_pos + 3 * body, model.body_quat + 4 * body) : Pose{};
  return UrdfLink{.origin = Frame::from_pose(at),
                  .axis = joint >= 0 ? vec3(model.jnt_axis + 3 * joint) : Vec3::UnitZ()};
}

Joint machine_joint(const mjModel& model, int joint) {
  KINFER_EXPECT(vec3(model.jnt_pos + 3 * joint).isZero(), "a machine's joint lies at its body's origin");
  const int type = model.jnt_type[joint];
  KINFER_EXPECT(type == mjJNT_HINGE || type == mjJNT_SLIDE);
  Joint made{.name = mujoco().mj_id2name(&model, mjOBJ_JOINT, joint),
             .type = type == mjJNT_HINGE ? JointType::revolute : JointType::prismatic};
  if (model.jnt_limited[joint]) {
    made.lower = model.jnt_range[2 * joint];
    made.upper = model.jnt_range[2 * joint + 1];
  }
  return made;
}

/// Joints of all bodies, parents first; entry b of the result is the chain's joint whose frame is body b.
std::vector<int> add_bodies(const mjModel& model, Chain& chain) {
  std::vector<int> frame_of_body(model.nbody, -1);
  for (int body = 1; body < model.nbody; ++body) {
    int parent = frame_of_body[model.body_parentid[body]];
    const int first = model.body_jntadr[body], count = model.body_jntnum[body];
    for (int k = 0; k < std::max(count, 1); ++k) {
      const int joint = count > 0 ? first + k : -1;
      Joint made = count > 0 ? machine_joint(model, joint)
                             : Joint{.name = mujoco().mj_id2name(&model, mjOBJ_BODY, body),
                                     .type = JointType::fixed,
                                     .is_active = false};
      made.parent = parent;
      made.link = joint_link(model, body, joint, k == 0);
      parent = static_cast<int>(chain.joints.size());
      chain.joints.push_back(std::move(made));
    }
    frame_of_body[body] = parent;
  }
  return frame_of_body;
}

int find_parent_sensor(const Machine& machine, int joint) {
  for (int j = machine.chain.joints[joint].parent; j >= 0; j = machine.chain.joints[j].parent)
    for (std::size_t s = 0; s < machine.sensors.size(); ++s)
      if (machine.sensors[s].joint == j) return static_cast<int>(s);
  return -1;
}

Machine read_machine(const mjModel& model) {
  Machine machine;
  machine.chain.name = model.names;  // the model's name comes first
  machine.chain.gravity = vec3(model.opt.gravity);
  const std::vector<int> frame_of_body = add_bodies(model, machine.chain);
  for (int site = 0; site < model.nsite; ++site) {
    const int body = model.site_bodyid[site], joint = frame_of_body[body];
    MountedSensor sensor{.name = mujoco().mj_id2name(&model, mjOBJ_SITE, site),
                         .segment = mujoco().mj_id2name(&model, mjOBJ_BODY, body),
                         .joint = joint,
                         .segment_T_sensor = pose(model.site_pos + 3 * site, model.site_quat + 4 * site)};
    sensor.parent = find_parent_sensor(machine, joint);
    machine.sensors.push_back(std::move(sensor));
  }
  machine.base_dof = model.body_jntnum[1];
  KINFER_EXPECT(model.nkey == 1 && model.nq == model.nv);
  machine.home = Eigen::Map<const VectorXd>(model.key_qpos, model.nq);
  return machine;
}

/// Addresses of a site's accelerometer, gyro and magnetometer in mjData::sensordata.
struct SensorAddresses {
  int accelerometer = -1, gyro = -1, magnetometer = -1;
};

std::vector<SensorAddresses> find_sensor_addresses(const mjModel& model) {
  std::vector<SensorAddresses> addresses(model.nsite);
  for (int s = 0; s < model.nsensor; ++s) {
    SensorAddresses& place = addresses[model.sensor_objid[s]];
    const int address = model.sensor_adr[s];
    if (model.sensor_type[s] == mjSENS_ACCELEROMETER) place.accelerometer = address;
    if (model.sensor_type[s] == mjSENS_GYRO) place.gyro = address;
    if (model.sensor_type[s] == mjSENS_MAGNETOMETER) place.magnetometer = address;
  }
  for (const SensorAddresses& place : addresses)
    KINFER_EXPECT(place.accelerometer >= 0 && place.gyro >= 0 && place.magnetometer >= 0, "a site without sensors");
  return addresses;
}

void record(const mjModel& model, const mjData& data, const std::vector<SensorAddresses>& addresses, std::size_t row,
            MachineMotion& motion) {
  const auto column = static_cast<Eigen::Index>(row);
  motion.q.col(column) = Eigen::Map<const VectorXd>(data.qpos, model.nq);
  motion.qd.col(column) = Eigen::Map<const VectorXd>(data.qvel, model.nv);
  motion.qdd.col(column) = Eigen::Map<const VectorXd>(data.qacc, model.nv);
  for (std::size_t s = 0; s < addresses.size(); ++s) {
    SensorMotion& sensor = motion.sensors[s];
    mjtNum orientation[4];
    mujoco().mju_mat2Quat(orientation, data.site_xmat + 9 * s);
    sensor.world_R_sensor[row] = quat(orientation);
    sensor.position[row] = vec3(data.site_xpos + 3 * s);
    sensor.force[row] = vec3(data.sensordata + addresses[s].accelerometer);
    sensor.angular_velocity[row] = vec3(data.sensordata + addresses[s].gyro);
    sensor.field[row] = vec3(data.sensordata + addresses[s].magnetometer);
  }
}

VectorXd inertia_about_joints(const mjModel& model, mjData& data) {
  mujoco().mj_forward(&model, &data);
  MatrixXd mass(model.nv, model.nv);
  mujoco().mj_fullM(&model, mass.data(), data.qM);
  return mass.diagonal();
}

bool is_unstable(const mjData& data) {
  return data.warning[mjWARN_BADQPOS].number + data.warning[mjWARN_BADQVEL].number +
             data.warning[mjWARN_BADQACC].number >
         0;
}

}  // namespace

struct MujocoWorld::Engine {
  Model model;
  Machine machine;
};

MujocoWorld::MujocoWorld(std::unique_ptr<Engine> engine) : engine_(std::move(engine)) {}
MujocoWorld::~MujocoWorld() = default;
MujocoWorld::MujocoWorld(MujocoWorld&&) noexcept = default;
MujocoWorld& MujocoWorld::operator=(MujocoWorld&&) noexcept = default;

const Machine& MujocoWorld::machine() const {
  return engine_->machine;
}

Result<MujocoWorld> MujocoWorld::load(const std::string& mjcf) {
  if (auto found = load_mujoco(); !found) return forward_error(found.error());
  install_callbacks();
  const auto files = std::make_unique<mjVFS>();  // 2 MB: not for the stack
  mujoco().mj_defaultVFS(files.get());
  mujoco().mj_makeEmptyFileVFS(files.get(), file_name, static_cast<int>(mjcf.size()));
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  char why[1000] = "";
  Model model(mujoco().mj_loadXML(file_name, files.get(), why, sizeof why));
  mujoco().mj_deleteVFS(files.get());
  if (!model) return error("{}: {}", file_name, why);
  Machine machine = read_machine(*model);
  return MujocoWorld(std::make_unique<Engine>(Engine{std::move(model), std::move(machine)}));
}

Result<MachineMotion> MujocoWorld::drive(const Drive& drive, double sampling_rate, Servo servo) const {
  const Model model(mujoco().mj_copyModel(nullptr, engine_->model.get()));
  const Data data(mujoco().mj_makeData(model.get()));
  const double longest_step = servo == Servo::stiff ? stiff_step : soft_step;
  const int substeps = static_cast<int>(std::ceil(1.0 / (sampling_rate * longest_step) - 1e-9));
  model->opt.timestep = 1.0 / (sampling_rate * substeps);
  mujoco().mj_resetDataKeyframe(model.get(), data.get(), 0);
  const std::vector<SensorAddresses> addresses = find_sensor_addresses(*model);
  const Controller controller{&drive, servo, inertia_about_joints(*model, *data)};
  active_controller = &controller;

  MachineMotion motion = make_motion(machine(), row_count(drive.duration, sampling_rate), sampling_rate);
  const int first_row = -static_cast<int>(settling_time * sampling_rate), rows = static_cast<int>(motion.time.size());
  for (int row = first_row; row < rows; ++row) {
    data->time = row / sampling_rate;  // exact, not accumulated over steps
    if (row >= 0) {
      mujoco().mj_forward(model.get(), data.get());
      record(*model, *data, addresses, static_cast<std::size_t>(row), motion);
    }
    for (int step = 0; step < substeps; ++step) mujoco().mj_step(model.get(), data.get());
  }
  active_controller = nullptr;
  if (is_unstable(*data)) return error("the simulation became unstable: a gentler script or another seed may help");
  return motion;
}

MachineMotion MujocoWorld::prescribe(const Drive& drive, double sampling_rate) const {
  const mjModel* model = engine_->model.get();
  const Data data(mujoco().mj_makeData(model));
  const std::vector<SensorAddresses> addresses = find_sensor_addresses(*model);
  MachineMotion motion = make_motion(machine(), row_count(drive.duration, sampling_rate), sampling_rate);
  for (std::size_t row = 0; row < motion.time.size(); ++row) {
    for (std::size_t k = 0; k < drive.joints.size(); ++k) {
      const JointState state = state_at(drive.joints[k], motion.time[row]);
      data->qpos[k] = state.q;
      data->qvel[k] = state.qd;
      data->qacc[k] = state.qdd;
    }
    mujoco().mj_inverse(model, data.get());
    record(*model, *data, addresses, row, motion);
  }
  return motion;
}

}  // namespace kinfer
