// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/srdf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "softgauss/engine/model/followers.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/urdf_xml.hpp"
#include "softgauss/io/inputs.hpp"

namespace softgauss::io {
namespace {

using detail::XmlElement;

constexpr std::size_t kMostListed = 6;

/// The number of a joint; nothing where it has several, one for each degree of freedom.
std::optional<double> onlyNumber(const XmlElement& joint) {
  const std::string text = joint.requiredText("value");
  const std::optional<std::vector<double>> numbers = detail::parseNumbers(text);
  if (numbers && numbers->size() > 1) return std::nullopt;
  return joint.requiredNumber("value");
}

Srdf::State groupState(const XmlElement& state) {
  Srdf::State read;
  read.name = state.named("group_state").requiredText("name");
  read.group = state.firstText("group");
  const std::string label = "group_state '" + read.name + "'";
  for (const XmlElement& joint : state.children("joint")) {
    const std::string name = joint.named(label + ": joint").requiredText("name");
    const XmlElement named = joint.named(fmt::format("{}: joint '{}'", label, name));
    if (const std::optional<double> value = onlyNumber(named))
      read.joints.emplace_back(name, *value);
  }
  return read;
}

std::pair<std::string, std::string> linksOf(const XmlElement& pair) {
  const XmlElement named = pair.named(pair.tag());
  return {named.requiredText("link1"), named.requiredText("link2")};
}

/// The name of the robot that an SRDF is for; "" where the file cannot be read.
std::string robotNamed(const std::filesystem::path& file) {
  try {
    const std::string text = detail::readInput(file.string(), "an SRDF");
    return detail::XmlFile(file.string(), text).robot().firstText("name");
  } catch (const ModelError&) {
    return "";
  }
}

std::vector<std::filesystem::path> srdfsIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error))
    if (at->path().extension() == ".srdf") files.push_back(at->path().lexically_normal());
  std::sort(files.begin(), files.end());
  return files;
}

std::pair<std::string, std::string> ordered(const std::string& a, const std::string& b) {
  return a < b ? std::pair(a, b) : std::pair(b, a);
}

std::vector<std::string> textsOf(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> texts;
  for (const std::filesystem::path& file : files) texts.push_back(file.string());
  return texts;
}

}  // namespace

std::vector<std::string> Srdf::stateNames() const {
  std::vector<std::string> names;
  for (const State& state : states)
    if (std::find(names.begin(), names.end(), state.name) == names.end())
      names.push_back(state.name);
  return names;
}

std::vector<std::pair<std::string, double>> Srdf::positions(const std::string& name) const {
  std::map<std::string, double> found;
  bool any = false;
  for (const State& state : states) {
    if (state.name != name && state.group + "/" + state.name != name) continue;
    any = true;
    for (const auto& [joint, value] : state.joints) found[joint] = value;
  }
  if (any) return {found.begin(), found.end()};
  throw ModelError({file.string(), 0}, "state " + detail::quotedText(name),
                   "found none of that name, expected the name of a group_state" +
                       detail::offered(name, stateNames()));
}

Srdf::LinkPairs Srdf::apartAmong(const std::vector<std::string>& links) const {
  const std::set<std::string> known(links.begin(), links.end());
  std::set<std::pair<std::string, std::string>> pairs;
  for (const std::string& alone : apartFromOthers)
    if (known.count(alone))
      for (const std::string& link : known)
        if (link != alone) pairs.insert(ordered(alone, link));
  for (const auto& [a, b] : together) pairs.erase(ordered(a, b));
  for (const auto& [a, b] : apart)
    if (known.count(a) && known.count(b)) pairs.insert(ordered(a, b));
  return {pairs.begin(), pairs.end()};
}

Srdf readSrdf(const std::filesystem::path& file) {
  Srdf srdf;
  srdf.file = file;
  const std::string text = detail::readInput(file.string(), "an SRDF");
  const detail::XmlFile xml(file.string(), text);
  const XmlElement robot = xml.robot();
  for (const XmlElement& state : robot.children("group_state"))
    srdf.states.push_back(groupState(state));
  for (const XmlElement& pair : robot.children("disable_collisions"))
    srdf.apart.push_back(linksOf(pair));
  for (const XmlElement& pair : robot.children("enable_collisions"))
    srdf.together.push_back(linksOf(pair));
  for (const XmlElement& link : robot.children("disable_default_collisions"))
    srdf.apartFromOthers.push_back(link.named(link.tag()).requiredText("link"));
  return srdf;
}

std::vector<std::filesystem::path> findSrdfs(const std::filesystem::path& urdf,
                                             const std::string& robot) {
  if (urdf == kStandardInput) return {};
  const std::filesystem::path folder = urdf.has_parent_path() ? urdf.parent_path() : ".";
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& place :
       {folder, folder / "srdf", folder / "config", folder / "..", folder / ".." / "srdf",
        folder / ".." / "config"})
    for (std::filesystem::path& file : srdfsIn(place)) files.push_back(std::move(file));
  for (const std::filesystem::path& file : files)
    if (file.stem() == urdf.stem()) return {file};
  files.erase(std::remove_if(files.begin(), files.end(),
                             [&](const auto& file) { return robotNamed(file) != robot; }),
              files.end());
  return files;
}

Srdf chooseSrdf(const std::filesystem::path& urdf, const std::string& robot,
                const SrdfChoice& choice, const SourceLocation& where, const std::string& element,
                std::vector<std::string>& warnings) {
  const bool named = !choice.file.empty() && choice.file != "none", asked = !choice.state.empty();
  std::vector<std::filesystem::path> files;
  if (named)
    files = {choice.file};
  else if (choice.file.empty() && (choice.search || asked))
    files = findSrdfs(urdf, robot);
  const std::string several = fmt::format("{} SRDFs for the robot '{}': {}", files.size(), robot,
                                          detail::listed(textsOf(files), kMostListed));
  if (asked && files.size() != 1)
    throw ModelError(where, element,
                     fmt::format("found {}; expected {}",
                                 files.size() > 1      ? several
                                 : choice.file.empty() ? "no SRDF in the package of the URDF"
                                                       : "'none' as the SRDF",
                                 "one by " + choice.named));
  if (files.size() > 1) warnings.push_back(fmt::format("{}; {} takes one", several, choice.named));
  if (files.size() != 1) return {};
  try {
    Srdf srdf = readSrdf(files.front());
    if (asked) srdf.positions(choice.state);
    return srdf;
  } catch (const ModelError& error) {
    if (named || asked) throw;
    warnings.push_back(std::string("SRDF left out: ") + error.what());
    return {};
  }
}

std::vector<std::string> placeState(const Model& model, const Srdf& srdf, const std::string& state,
                                    const std::string& prefix, VectorX& q) {
  std::vector<std::string> moved, missing, reported;
  std::vector<std::pair<std::string, double>> asked = srdf.positions(state);
  for (const auto& [joint, value] : asked) {
    const int body = model.findJoint(prefix + joint);
    if (body < 0 || model.bodies[idx(body)].dofs != 1) {
      missing.push_back(joint);
      continue;
    }
    double& position = q[model.bodies[idx(body)].q];
    position = value;
    for (const JointRange& range : model.ranges)
      if (range.body == body) position = std::clamp(position, range.lower, range.upper);
  }
  placeFollowers(model, {}, q);
  for (const auto& [joint, value] : asked) {
    const int body = model.findJoint(prefix + joint);
    if (body < 0 || model.bodies[idx(body)].dofs != 1) continue;
    const double at = q[model.bodies[idx(body)].q];
    if (std::abs(at - value) > kFollowerTolerance)
      moved.push_back(fmt::format("{} from {:.4g} to {:.4g}", joint, value, at));
  }
  const auto report = [&](const char* what, const std::vector<std::string>& joints) {
    if (!joints.empty())
      reported.push_back(fmt::format("state '{}' of {}: {}: {}", state,
                                     srdf.file.filename().string(), what,
                                     detail::listed(joints, kMostListed)));
  };
  report("moved to where ranges and leaders let them be", moved);
  report("the robot has no joints of these names", missing);
  return reported;
}

std::string describe(const Srdf& srdf, const std::vector<std::string>& links,
                     const std::string& by) {
  std::vector<std::string> parts;
  const std::vector<std::string> states = srdf.stateNames();
  if (!states.empty())
    parts.push_back(fmt::format("states, by {}: {}", by, detail::listed(states)));
  if (const std::size_t pairs = srdf.apartAmong(links).size(); pairs > 0)
    parts.push_back(detail::counted(pairs, "pair") + " of links never collide");
  return fmt::format("SRDF {}: {}", srdf.file.string(),
                     parts.empty() ? "no states" : fmt::format("{}", fmt::join(parts, "; ")));
}

}  // namespace softgauss::io
