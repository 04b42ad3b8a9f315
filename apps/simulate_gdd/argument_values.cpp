// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/argument_values.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <vector>

namespace softgauss::app {
namespace {

constexpr double kLargest = 1e12;  // as in files

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

Vector3 parsePoint(const std::string& text, const std::string& context) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 3)
    throw UsageError(fmt::format("{}: '{}' is not three numbers x,y,z", context, text));
  return {parseNumber(parts[0], context), parseNumber(parts[1], context),
          parseNumber(parts[2], context)};
}

}  // namespace

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

double parseNumber(const std::string& given, const std::string& context) {
  const std::string text = trimmed(given);
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value))
    throw UsageError(fmt::format("{}: '{}' is not a number", context, text));
  if (std::abs(value) > kLargest)
    throw UsageError(fmt::format("{}: found {}, expected a number of size {:g} at most", context,
                                 text, kLargest));
  return value;
}

double parseWeight(const std::string& text, const std::string& context) {
  const double weight = parseNumber(text, context);
  if (!(weight >= 0.0 && weight <= kLargest))
    throw UsageError(fmt::format("{}: found the weight {}, expected 0 to 1e12", context, weight));
  return weight;
}

std::uintmax_t bytesOf(double megabytes, const std::string& context) {
  constexpr double kMost = 1e6;
  if (!(megabytes > 0.0 && megabytes <= kMost))
    throw UsageError(fmt::format("{} {:g}: expected megabytes, above 0 and at most {:g}", context,
                                 megabytes, kMost));
  return static_cast<std::uintmax_t>(megabytes * (1 << 20));
}

ReachArgument parseReach(const std::string& text) {
  const std::string context = "--reach " + text;
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos)
    throw UsageError(context + ": expected LINK=x,y,z or LINK:ox,oy,oz=x,y,z");
  ReachArgument reach;
  reach.link = trimmed(text.substr(0, equals));
  std::string place = text.substr(equals + 1);
  if (const std::size_t at = place.find('@'); at != std::string::npos) {
    reach.weight = parseWeight(place.substr(at + 1), context);
    place.resize(at);
  }
  reach.p_WTarget = parsePoint(place, context);
  if (const std::size_t colon = reach.link.rfind(':'); colon != std::string::npos) {
    reach.p_FP = parsePoint(reach.link.substr(colon + 1), context);
    reach.link.resize(colon);
  }
  return reach;
}

EffectSet parseEffects(const std::string& text) {
  if (text == "auto") return EffectSet::all();
  if (text == "none") return EffectSet::none();
  const std::string no = "no_";
  EffectSet kept = EffectSet::none(), dropped = EffectSet::none();
  for (const std::string& name : split(text, ',')) {
    const bool without = name.rfind(no, 0) == 0;
    const std::optional<Effect> effect = effectFromName(without ? name.substr(no.size()) : name);
    if (!effect) {
      std::string known;
      for (const EffectName& e : kEffectNames) known += fmt::format(" {}", e.name);
      throw UsageError(
          fmt::format("--effects: no effect '{}'; there are:{}; or auto, or none", name, known));
    }
    (without ? dropped : kept).insert(*effect);
  }
  if (kept == EffectSet::none()) kept = EffectSet::all();  // all but the dropped ones
  for (const EffectName& e : kEffectNames)
    if (dropped.has(e.effect)) kept.remove(e.effect);
  return kept;
}

MechanismSet parseWithout(const std::string& text) {
  MechanismSet kept = MechanismSet::all();
  for (const std::string& name : split(text, ',')) {
    const std::optional<Mechanism> mechanism = mechanismFromName(name);
    if (!mechanism) {
      std::string known;
      for (const MechanismName& m : kMechanismNames) known += fmt::format(" {}", m.name);
      throw UsageError(fmt::format("--without: no mechanism '{}'; there are:{}", name, known));
    }
    kept.remove(*mechanism);
  }
  return kept;
}

}  // namespace softgauss::app
