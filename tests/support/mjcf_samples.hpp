// SPDX-License-Identifier: Apache-2.0
// MJCF files as people write them.
#pragma once

#include <string>

namespace kinfer::test {

// Line ends of both kinds, both quotes, entities, comments that look like bodies, defaults with inheritance, every kind
// of orientation, two joints in a body with points of their own, references, a body without name and place, a branch,
// joints that follow others. MuJoCo 2.2 reads it.
inline std::string awkward_mjcf() {
  return "<?xml version=\"1.0\"?>\r\n<!-- <body name=\"shoulder\" pos=\"9 9 9\"/> -->\r\n"
         "<mujoco model='arm &amp; hand'>\r\n"
         "  <compiler angle=\"degree\" eulerseq='zYx' boundmass=\"0.001\" boundinertia=\"0.001\"/>\r\n"
         "  <default>\r\n    <default class='wrist'><joint axis='1 0 0' pos=\"0.01 0 0.02\"/>\r\n"
         "      <default class=\"tool\"><joint type='slide' axis=\"0 0 1\" range=\"-3 3\" "
         "limited='true'/></default>\r\n"
         "    </default>\r\n    <joint axis=\"0 1 0\" damping=\"1\"/>\r\n    <geom contype='0' conaffinity='0'/>\r\n"
         "  </default>\r\n"
         "  <asset><material name=\"grey\" rgba=\".5 .5 .5 1\"/></asset>\r\n"
         "  <worldbody>\r\n\t<light pos=\"0 0 3\"/>\n\t<geom type=\"plane\" size=\"1 1 .1\"/>\r\n"
         "    <body name=\"base\" pos='0.1 0.2 0.3' quat=\"0 0 0 2\">\r\n"
         "      <geom type=\"sphere\" size=\".05\" material='grey'/>\r\n"
         "      <body name='shoulder' pos='0  0 0.5' euler = \"10 20 -30\" >\r\n"
         "        <joint name=\"pan\" axis=\"0 0 2\" ref=\"15\" range=\"-170 190\" limited=\"true\"/>\r\n"
         "        <joint name='lift' pos='0.02 -0.01 0.05' ref='-20'/><!-- axis by default -->\r\n"
         "        <body name=\"upper\"\n              pos=\"+.3 0 0\"\n              axisangle=\"0 0 3 40\">\n"
         "          <joint name=\"elbow\" class=\"wrist\" ref=\"5\"/>\r\n"
         "          <body name=\"part\" pos=\"0 0 .1\" xyaxes=\"0 1 0 -1 0.5 0\">\r\n"
         "            <body childclass=\"wrist\">\r\n              <joint name=\"roll\"/>\r\n"
         "              <geom type=\"sphere\" size=\".02\"/>\r\n"
         "              <body name=\"twist\" xyaxes=\"0 0 1 0 1 0\">\r\n                <joint name=\"yaw\"/>\r\n"
         "                <body name=\"hand\" zaxis=\"0.1 0.2 1\" pos=\"0 0.1 0\">\r\n"
         "                  <joint name=\"slide\" class=\"tool\"/>\r\n"
         "                  <joint name=\"follower\" axis=\"0 1 1\" ref=\"30\"/>\r\n"
         "                  <site name=\"tcp\" pos=\"0 0 .1\" euler='0 0 45'/>\r\n"
         "                </body>\r\n              </body>\r\n            </body>\r\n          </body>\r\n"
         "        </body>\r\n        <body name=\"side\" pos=\"0 1 0\"><joint name=\"branch\"/></body>\r\n"
         "      </body>\r\n    </body>\r\n  </worldbody>\r\n"
         "  <equality>\r\n    <joint joint1=\"branch\" joint2=\"follower\" polycoef=\"0 2 0 0 0\"/>\r\n"
         "    <joint joint1=\"follower\" joint2=\"pan\" polycoef=\"0.1 -0.5 0 0 0\"/>\r\n"
         "    <joint joint1=\"roll\" joint2=\"pan\" polycoef=\"0 1 1 0 0\" active='false'/>\r\n  </equality>\r\n"
         "  <actuator><position joint=\"pan\" kp=\"10\"/></actuator>\r\n</mujoco>\n<!-- end -->";
}

/// The same machine twice: by <frame> elements, which MuJoCo has since 3.1, and by bodies and joints alone.
inline std::string framed_mjcf() {
  return "<mujoco><compiler angle='radian'/><default><default class='across'><joint axis='1 0 0'/></default></default>"
         "<worldbody><frame pos='1 2 3' euler='0 0 1.5707963267948966'><frame pos='1 0 0'>"
         "<body name='a' pos='0 1 0'><frame pos='0 0 2' axisangle='0 1 0 1.5707963267948966' childclass='across'>"
         "<joint name='j1' pos='0.5 0 0'/><body name='b' pos='0 0 1'><joint name='j2' class='main'/></body>"
         "<site name='s' pos='1 0 0'/></frame></body></frame></frame></worldbody></mujoco>";
}

inline std::string unframed_mjcf() {
  return "<mujoco><compiler angle='radian'/><default><default class='across'><joint axis='1 0 0'/></default></default>"
         "<worldbody><body name='a' pos='0 3 3' euler='0 0 1.5707963267948966'>"
         "<joint name='j1' axis='0 0 -1' pos='0 0 1.5'/>"
         "<body name='b' pos='1 0 2' axisangle='0 1 0 1.5707963267948966'><joint name='j2'/></body>"
         "<site name='s' pos='0 0 1' axisangle='0 1 0 1.5707963267948966'/></body></worldbody></mujoco>";
}

}  // namespace kinfer::test
