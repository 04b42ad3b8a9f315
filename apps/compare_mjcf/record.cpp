// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mjcf/record.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

/// What is not finite becomes null.
Json listOf(const VectorX& x) {
  Json list = Json::array();
  for (const double number : x) list.push_back(std::isfinite(number) ? Json(number) : Json());
  return list;
}

VectorX vectorFrom(const Json& list) {
  VectorX x(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i)
    x[static_cast<Eigen::Index>(i)] =
        list[i].is_null() ? std::numeric_limits<double>::infinity() : list[i].get<double>();
  return x;
}

}  // namespace

void writeRecord(const MjcfNumbers& numbers, const std::filesystem::path& file) {
  Json json{{"nq", numbers.nq},
            {"nv", numbers.nv},
            {"mass", numbers.mass},
            {"body_masses", numbers.bodyMasses}};
  for (const MjcfState& s : numbers.states)
    json["states"].push_back({{"q", listOf(s.q)},
                              {"v", listOf(s.v)},
                              {"M", listOf(s.M.reshaped())},
                              {"bias", listOf(s.bias)},
                              {"passive", listOf(s.passive)},
                              {"a", listOf(s.a)}});
  json["actuators"] = Json::array();
  for (std::size_t i = 0; i < numbers.least.size(); ++i)
    json["actuators"].push_back(
        {{"least", listOf(numbers.least[i])}, {"most", listOf(numbers.most[i])}});
  if (!(std::ofstream(file) << json.dump() << "\n" << std::flush))
    throw std::runtime_error(file.string() + " cannot be written");
}

MjcfNumbers readRecord(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + " cannot be read");
  const Json json = Json::parse(in);
  MjcfNumbers numbers;
  numbers.nq = json.at("nq");
  numbers.nv = json.at("nv");
  numbers.mass = json.at("mass");
  numbers.bodyMasses = json.at("body_masses").get<std::vector<double>>();
  for (const Json& s : json.at("states")) {
    MjcfState state;
    state.q = vectorFrom(s.at("q"));
    state.v = vectorFrom(s.at("v"));
    state.M = vectorFrom(s.at("M")).reshaped(numbers.nv, numbers.nv);
    state.bias = vectorFrom(s.at("bias"));
    state.passive = vectorFrom(s.at("passive"));
    state.a = vectorFrom(s.at("a"));
    numbers.states.push_back(std::move(state));
  }
  for (const Json& a : json.at("actuators")) {
    numbers.least.push_back(vectorFrom(a.at("least")));
    numbers.most.push_back(vectorFrom(a.at("most")));
  }
  return numbers;
}

}  // namespace softgauss::app
