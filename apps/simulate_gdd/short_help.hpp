// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What --help prints: five commands to begin with and the options that most runs take, on one
/// screen. --help-all lists all options.

#include <CLI/CLI.hpp>
#include <string>

namespace softgauss::app {

/// At most 40 lines of at most 100 characters.
inline constexpr const char* kShortHelp =
    R"(Simulates a robot under goal directed dynamics: at every step the controls are found that
bring it nearer its goals, with the contact forces that then act.

  simulate_gdd humanoid.urdf --reach right_hand=0.4,-0.2,1.2 --view motion.html
  simulate_gdd arm.urdf --base fixed --posture --reach hand=0.5,0.3,0.5
  simulate_gdd scene.yaml --goals goals.yaml --duration 5 --log run.csv
  simulate_gdd robot.urdf --explain
  simulate_gdd humanoid.urdf --posture --live

MODEL is a .urdf file, or a .yaml scene (docs/reference/scenes.md).

Scene:
  --base fixed|floating|auto       how the root link meets the world
  --ground HEIGHT|none             the ground plane [m]
  --q0 JOINT=VALUE,...             where joints start [rad or m]
  --package-path DIR               where package://NAME/... is looked for first
Goals:
  --reach LINK[:x,y,z]=x,y,z[@W]   the link, or a point of it, seeks a place in the world [m]
  --hold LINK                      the link stays where and as it is
  --posture[=W]                    all joints and the base seek the initial posture
  --goals FILE.yaml                goals with times and weights (docs/reference/goals.md)
  --plan, --mpc                    plan the motion that a scene asks for, once or again and again
  --servos                         no goals: servos of the file follow their set points
  --passive                        no goals, no controls, no servos
  --torques FILE.csv               controls instead of goals
Simulation:
  --duration S, --timestep S       default 2 and 0.002
  --live                           in real time, on a page in which you pull links by the mouse
Output:
  --explain                        what was loaded, and why; no simulation
  --view FILE.html                 a page that replays the run
  --log FILE.csv|FILE.mcap         every step
  --summary FILE.json              verdict, goals and figures
  --plot FILE.svg                  curves
  --quiet                          errors only

--help-all lists all options; docs/README.md, installed in share/softgauss, where to read on.
)";

/// kShortHelp for --help; --help-all as CLI11 makes it.
class ShortHelp final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    return mode == CLI::AppFormatMode::Normal
               ? kShortHelp
               : CLI::Formatter::make_help(app, std::move(name), CLI::AppFormatMode::Normal);
  }
};

}  // namespace softgauss::app
