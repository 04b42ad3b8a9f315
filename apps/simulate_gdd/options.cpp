// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "apps/simulate_gdd/argument_values.hpp"
#include "apps/simulate_gdd/checkpoint_options.hpp"
#include "apps/simulate_gdd/command_line.hpp"
#include "apps/simulate_gdd/live_options.hpp"
#include "apps/simulate_gdd/plan_options.hpp"
#include "apps/simulate_gdd/short_help.hpp"
#include "softgauss/io/inputs.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/named_options.hpp"

namespace softgauss::app {
namespace {

constexpr double kFarthest = 1e6;  // [m] farther out, doubles no longer resolve a contact

/// Refuses options without their value: `--log ""`, and `--log=`, which would take the next
/// argument.
void expectValues(CLI::App& app, int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--") break;
    if (argument.starts_with("--") && argument.find('=') + 1 == argument.size())
      throw UsageError(argument + ": found nothing, expected a value");
  }
  const CLI::Validator hasText(
      [](const std::string& value) {
        return trimmed(value).empty() ? "found nothing, expected a value" : "";
      },
      "");
  for (CLI::Option* option : app.get_options())
    if (option->get_items_expected_max() > 0) option->check(hasText);
}

/// A second value behind an option is taken for MODEL, and MODEL for one too many.
void expectModelName(const std::filesystem::path& model) {
  std::error_code error;
  if (model.string().find('=') != std::string::npos && !std::filesystem::exists(model, error))
    throw UsageError(fmt::format(
        "found '{}' where MODEL is expected; an option takes one value, such as --q0 a=1,b=2",
        model.string()));
}

}  // namespace

std::optional<SimulateOptions> parseCommandLine(int argc, char** argv) {
  SimulateOptions options;
  CLI::App app(
      "Simulates a robot under goal directed dynamics: at every step the controls are found that\n"
      "bring it nearer its goals, with the contact forces that then act.");
  app.formatter(std::make_shared<ShortHelp>());
  app.set_help_flag("-h,--help", "how to begin, and the options that most runs take");
  app.set_help_all_flag("--help-all", "all options");
  app.set_version_flag("--version", std::string("softgauss ") + SOFTGAUSS_VERSION);
  std::string base = "automatic", ground, effects, without, zeroEffort = "passive", integrator,
              cone, solver, controlCost, budget, compatibility, sleep, posture, meshes, collision;
  std::vector<std::string> reach, q0;
  for (int i = 0; i < argc; ++i)
    options.commandLine +=
        i == 0 ? std::filesystem::path(argv[0]).filename().string() : fmt::format(" {}", argv[i]);

  app.add_option(
         "MODEL", options.model,
         "a .urdf file, or a .yaml scene (docs/reference/scenes.md); - reads either from standard "
         "input")
      ->required();
  const char* const scene = "Scene";
  app.add_option("--base", base,
                 "fixed or floating; auto guesses by what the robot would stand on; default:\n"
                 "floating, or fixed when the root link is 'world'")
      ->check(CLI::IsMember({"fixed", "floating", "auto"}))
      ->group(scene);
  app.add_option(
         "--base-height", options.baseHeight,
         "initial height of a floating root [m]; default: its lowest point touches the ground")
      ->group(scene);
  app.add_flag("--no-balance", options.noBalance,
               "beside --reach a robot that stands is not kept standing")
      ->group(scene);
  app.add_option("--ground", ground,
                 "height of the ground plane [m] or none; default: 0 for a floating base")
      ->group(scene);
  app.add_option("--q0", q0, "initial joint positions NAME=VALUE,… [rad or m]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(scene);
  app.add_option("--state", options.state,
                 "start in a state (group_state) of the SRDF, or a keyframe of the MJCF, by name;\n"
                 "--q0 comes on top")
      ->group(scene);
  app.add_option("--srdf", options.srdf,
                 "SRDF with states and links that never collide, or none; default: that of\n"
                 "the URDF's package")
      ->group(scene);
  app.add_option("--effects", effects,
                 "the effects to simulate: auto, none, a list, or no_NAME,… for all but those")
      ->group(scene);
  app.add_option("--zero-effort", zeroEffort,
                 "meaning of effort=\"0\": passive (not actuated) or unlimited")
      ->check(CLI::IsMember({"passive", "unlimited"}))
      ->group(scene);
  app.add_flag("--infer-inertia", options.inferInertia,
               "moving links without mass or inertia have that of their shapes, at 1000 kg/m³")
      ->group(scene);
  app.add_flag("--ignore-velocity-limits", options.ignoreVelocityLimits,
               "goals alone decide how fast joints move and arrive at an end of their range")
      ->group(scene);
  app.add_option(
         "--meshes", meshes,
         "collision shape of meshes where a scene names none. hull: the convex hull;\ntriangles: "
         "the mesh itself; auto (default): the hull where it is at most 5 %\n"
         "larger or the mesh moves, else the triangles")
      ->check(CLI::IsMember({"hull", "triangles", "auto"}))
      ->group(scene);
  app.add_option("--collision", collision,
                 "collision detection: own (default); fcl: FCL finds the touching pairs and "
                 "their\nnormals, slower, for a second opinion")
      ->check(CLI::IsMember({"own", "fcl"}))
      ->group(scene);
  app.add_option("--package-path", options.packagePaths,
                 "where package://NAME/… is looked for first; repeatable")
      ->allow_extra_args(false)
      ->group(scene);
  app.add_option("--most-dofs", options.mostDofs,
                 "the largest model that is loaded [degrees of freedom], default 2000")
      ->group(scene);
  double largestFile = 0.0;
  CLI::Option* const asksForFiles =
      app.add_option("--largest-file", largestFile,
                     "the largest URDF, scene, goals or table that is read [MB], default 64")
          ->group(scene);
  app.add_option("--largest-mesh", options.largestMesh,
                 "MB; a mesh file that is larger is refused, or as a visual not shown")
      ->check(CLI::Range(1e-3, 1e5))
      ->capture_default_str()
      ->group(scene);

  const char* const goals = "Goals";
  app.add_option(
         "--reach", reach,
         "LINK=x,y,z: the link's origin seeks a place in the world [m]; LINK:ox,oy,oz=x,y,z:\n"
         "a point of the link; …@WEIGHT: not with the default weight [kg]; repeatable")
      ->allow_extra_args(false)
      ->group(goals);
  app.add_option("--hold", options.hold, "LINK: it stays where and as it is; repeatable")
      ->allow_extra_args(false)
      ->group(goals);
  CLI::Option* const keepsPosture =
      app.add_flag(
             "--posture{1000}", posture,
             "all joints and the base seek the initial posture; --posture=WEIGHT [-], default "
             "1000")
          ->group(goals);
  app.add_option("--goals", options.goals, "a .yaml file of goals, see docs/reference/goals.md")
      ->group(goals);
  app.add_option("--torques", options.torques,
                 "a .csv file of controls (columns time_s, u:<joint>) instead of goals")
      ->group(goals);
  app.add_flag("--servos", options.servos, "no goals: servos of the file follow their set points")
      ->group(goals);
  app.add_flag("--passive", options.passive, "no goals, no controls, no servos")->group(goals);
  addPlanOptions(app, options);

  const char* const simulation = "Simulation";
  app.add_option("--duration", options.duration, "simulated time [s], default 2")
      ->group(simulation);
  app.add_option("--timestep", options.timestep, "step [s], default 0.002 or as the scene says")
      ->group(simulation);
  std::string integratorHelp;
  for (const IntegratorName& i : kIntegratorNames)
    integratorHelp += std::string(integratorHelp.empty() ? "" : ";\n") + std::string(i.name) +
                      (i.integrator == Integrator::leapfrog ? " (default): " : ": ") +
                      std::string(i.description);
  app.add_option("--integrator", integrator, integratorHelp)
      ->check(CLI::IsMember(io::integratorNames()))
      ->group(simulation);
  app.add_option("--integration-tolerance", options.integrationTolerance,
                 "largest error that a step of dormand-prince, or of --step-doubling, leaves\n"
                 "[m or rad], default 1e-6; where no integrator is named it is dormand-prince")
      ->group(simulation);
  app.add_flag("--step-doubling", options.stepDoubling,
               "error control for the integrators of one solve: each step once at its length and\n"
               "twice at half of it, shortened until both agree to --integration-tolerance")
      ->group(simulation);
  CLI::Option* accuracy =
      app.add_option("--accuracy", options.accuracy,
                     "find by trials the cheapest integrator, step and solver tolerance that\n"
                     "leave at most this error over the run [m], and use them")
          ->group(simulation);
  for (const char* chosen :
       {"--timestep", "--integrator", "--integration-tolerance", "--step-doubling"})
    accuracy->excludes(app.get_option(chosen));
  app.add_option("--cone", cone,
                 "pyramidal (default): friction pyramids, piecewise quadratic, the fastest;\n"
                 "elliptic: friction alike in all directions, rest depth independent of it")
      ->check(CLI::IsMember({"pyramidal", "elliptic"}))
      ->group(simulation);
  app.add_flag("--exact-diagonal", options.exactDiagonal,
               "softness of constraints from the present inertia, not from constants of the model")
      ->group(simulation);
  app.add_option("--without", without,
                 "mechanisms of the step to leave out, by name, for "
                 "comparisons\n(docs/stability.md has a table of them)")
      ->group(simulation);
  app.add_option(
         "--gdd-solver", solver,
         "active-set (default): over the controls, exact in the physics, with a certificate;\n"
         "augmented-lagrangian: the paper's primal-dual Gauss-Newton solver, slower with\n"
         "strong goals; it also solves where contacts have elliptic cones")
      ->check(CLI::IsMember({"active-set", "augmented-lagrangian"}))
      ->group(simulation);
  app.add_option("--control-cost", controlCost,
                 "about-gravity (default): cost of the force beyond gravity compensation, so "
                 "that\na reach ends at its target; total: cost of all force, as in the paper, and "
                 "links\nthat are held against gravity sag a little")
      ->check(CLI::IsMember({"about-gravity", "total"}))
      ->group(simulation);
  app.add_option("--budget", budget,
                 "most work for a control: iterations, as 20, or a time, as 200us, 1ms; past it "
                 "the\nbest that was found acts. With a time results depend on the machine")
      ->group(simulation);
  app.add_option("--compatibility", compatibility,
                 "none (default) or mujoco: MuJoCo's model, with Coriolis forces of the step's "
                 "start and\nconstraints that are not regularised by the mass that they support")
      ->check(CLI::IsMember({"none", "mujoco"}))
      ->group(simulation);

  app.add_option("--sleep", sleep,
                 "objects: what is at rest and no goal controls costs nothing until something\n"
                 "touches or pushes it; all: robots at rest under their goals too; none (default)")
      ->check(CLI::IsMember({"none", "objects", "all"}))
      ->group(simulation);

  addLiveOptions(app, options);
  addCheckpointOptions(app, options);

  const char* const output = "Output";
  app.add_flag("--explain", options.explain, "report what was loaded and simulate nothing")
      ->group(output);
  app.add_option("--log", options.log,
                 "write every step to a .csv or .mcap file; here and below - is standard output")
      ->group(output);
  app.add_option("--log-every", options.logEvery, "write every N-th step to the log, default 1")
      ->check(CLI::Range(1L, 1000000000L))
      ->group(output);
  app.add_option("--contacts", options.contacts,
                 "write every contact of every step to a .csv file, a row each")
      ->group(output);
  app.add_flag("--report-error", options.reportError,
               "estimate the error that the settings leave, by two half steps beside each step")
      ->group(output);
  app.add_option("--summary", options.summary, "write the summary to a .json file")->group(output);
  app.add_option("--view", options.view, "write a page that replays the run in any browser (.html)")
      ->group(output);
  app.add_option(
         "--view-with", options.viewWith,
         "show in that page, or the live one, also the run of another such page, translucent")
      ->group(output);
  app.add_option("--plot", options.plot,
                 "draw the run's curves with gnuplot: an .svg file, or a folder for one file each")
      ->group(output);
  app.add_flag("--details", options.details,
               "report at the end also the solver's statistics and times")
      ->group(output);
  app.add_flag("--quiet", options.quiet, "print errors only")->group(output);

  expectValues(app, argc, argv);
  std::vector<std::string> arguments = argumentsOf(argc, argv);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    if (!parses(app, std::move(arguments))) return std::nullopt;
  } catch (const UsageError&) {
    expectModelName(options.model);
    throw;
  }

  if (asksForFiles->count() > 0) io::inputLimits().text = bytesOf(largestFile, "--largest-file");
  if (options.mostDofs < 1)
    throw UsageError(fmt::format("--most-dofs {}: expected 1 or more", options.mostDofs));
  options.base = base == "fixed"      ? BaseKind::fixed
                 : base == "floating" ? BaseKind::floating
                                      : BaseKind::automatic;
  options.guessBase = base == "auto";
  options.groundIsDefault = ground.empty();
  if (!ground.empty() && ground != "none") options.ground = parseNumber(ground, "--ground");
  for (const auto& [option, value] : {std::pair{"--duration", options.duration},
                                      std::pair{"--timestep", options.timestep.value_or(1.0)}})
    if (!(value > 0.0) || !std::isfinite(value))
      throw UsageError(fmt::format("{} {}: expected a number of seconds above 0", option, value));
  if (options.accuracy && !(*options.accuracy > 0.0 && std::isfinite(*options.accuracy)))
    throw UsageError(
        fmt::format("--accuracy {:g}: expected metres of error above 0", *options.accuracy));
  if (const auto& tolerance = options.integrationTolerance)
    if (!(*tolerance > 0.0 && std::isfinite(*tolerance)))
      throw UsageError(fmt::format(
          "--integration-tolerance {:g}: expected metres or radians of error above 0", *tolerance));
  if (options.timestep) checkSteps(options, *options.timestep, {});
  const auto mustBeNear = [](double metres, const std::string& option) {
    if (!(std::abs(metres) <= kFarthest))
      throw UsageError(
          fmt::format("{}: {} m is not within {:g} m of the origin", option, metres, kFarthest));
  };
  if (options.baseHeight) {
    mustBeNear(*options.baseHeight, "--base-height");
    if (base == "fixed")
      throw UsageError("--base-height is for a floating base, and --base is fixed");
  }
  if (!integrator.empty()) options.integrator = io::integratorCalled(integrator);
  if (!cone.empty()) options.cone = cone == "elliptic" ? Cone::elliptic : Cone::pyramidal;
  if (!solver.empty())
    options.gddSolver =
        solver == "active-set" ? gdd::GddSolver::activeSet : gdd::GddSolver::augmentedLagrangian;
  if (!controlCost.empty())
    options.controlCost =
        controlCost == "total" ? gdd::ControlCost::total : gdd::ControlCost::aboutGravity;
  if (!budget.empty() && !setBudget(budget, options))
    throw UsageError(
        fmt::format("--budget {}: expected iterations, as 20, or a time, as 200us", budget));
  if (!meshes.empty())
    options.meshes = meshes == "hull"        ? io::MeshUse::hull
                     : meshes == "triangles" ? io::MeshUse::triangles
                                             : io::MeshUse::automatic;
  if (!collision.empty()) options.throughFcl = collision == "fcl";
  if (!compatibility.empty()) options.likeMujoco = compatibility == "mujoco";
  if (!sleep.empty()) options.sleep = io::sleepCalled(sleep);
  options.zeroEffortIsUnlimited = zeroEffort == "unlimited";
  if (app.count("--effects") > 0) options.effects = parseEffects(effects);
  if (app.count("--without") > 0) options.mechanisms = parseWithout(without);
  if (options.ground) mustBeNear(*options.ground, "--ground");
  for (const std::string& text : reach) {
    options.reach.push_back(parseReach(text));
    mustBeNear(options.reach.back().p_WTarget.cwiseAbs().maxCoeff(), "--reach " + text);
    mustBeNear(options.reach.back().p_FP.cwiseAbs().maxCoeff(), "--reach " + text);
  }
  if (keepsPosture->count() > 0) options.posture = parseWeight(posture, "--posture");
  for (const std::string& text : q0) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos) throw UsageError("--q0 " + text + ": expected NAME=VALUE");
    options.q0.emplace_back(trimmed(text.substr(0, equals)),
                            parseNumber(text.substr(equals + 1), "--q0"));
  }
  int fromStandardInput = 0;
  for (const auto* file :
       {&options.model, &options.goals, &options.torques, &options.play, &options.viewWith})
    fromStandardInput += *file == io::kStandardInput ? 1 : 0;
  if (fromStandardInput > 1)
    throw UsageError(
        "standard input (-) can be only one of MODEL, --goals, --torques, --play and --view-with");
  if (!options.viewWith.empty() && options.view.empty() && !options.live)
    throw UsageError("--view-with is for a page, expected --view or --live too");
  finishLiveOptions(app, options);
  finishPlanOptions(app, options);
  finishCheckpointOptions(app, options);
  checkOutputs(options, {});
  if (options.isScene())
    for (const auto& [option, given] :
         {std::pair{"--base", !base.empty() && base != "automatic"},
          std::pair{"--base-height", options.baseHeight.has_value()},
          std::pair{"--state", !options.state.empty()}, std::pair{"--srdf", !options.srdf.empty()},
          std::pair{"--ground", !ground.empty()}})
      if (given)
        throw UsageError(fmt::format("{} is for a URDF; a scene file says it itself", option));
  const bool hasGoals = options.hasGoals();
  if (int{options.passive} + int{options.servos} + int{!options.torques.empty()} + int{hasGoals} >
      1)
    throw UsageError(
        "choose one of goals (--reach, --hold, --posture, --goals), --servos, --torques and "
        "--passive");
  if (!options.isScene() && !options.passive && !options.servos && options.torques.empty() &&
      !hasGoals && !options.explain)
    throw UsageError(
        "nothing to do: give a goal (--reach LINK=x,y,z, --hold LINK, --posture or --goals FILE), "
        "--torques FILE, --servos or --passive");
  return options;
}

}  // namespace softgauss::app
