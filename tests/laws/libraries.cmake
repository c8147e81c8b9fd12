# SPDX-License-Identifier: Apache-2.0
# MuJoCo is the independent reference of poses and motions; tests only. Its own package file would require OpenGL too.
find_path(MUJOCO_INCLUDE mujoco/mujoco.h REQUIRED)
find_library(MUJOCO_LIBRARY mujoco REQUIRED)
set(KINFER_TEST_LIBRARIES ${MUJOCO_LIBRARY})
