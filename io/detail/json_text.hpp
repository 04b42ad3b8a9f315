// SPDX-License-Identifier: Apache-2.0
#pragma once

/// JSON that is written while a run goes on, member by member, into text that is used again.

#include <cmath>
#include <string>

#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {

/// The name as JSON has it, in quotes.
std::string jsonName(const std::string& name);

/// Commas come by themselves. Names are as of jsonName(), or plain.
class JsonText {
 public:
  const std::string& text() const { return text_; }
  void clear() { text_.clear(); }

  JsonText& open(char bracket) {  ///< an object or a list as an element, or as the whole
    comma();
    text_ += bracket;
    return *this;
  }
  JsonText& open(const std::string& name, char bracket) {
    key(name);
    text_ += bracket;
    return *this;
  }
  JsonText& close(char bracket) {
    text_ += bracket;
    return *this;
  }
  JsonText& raw(const std::string& name, const std::string& json) {
    key(name);
    text_ += json;
    return *this;
  }
  /// A number that is not finite has no place in JSON: the member is left out.
  JsonText& number(const std::string& name, double x) {
    if (!std::isfinite(x)) return *this;
    key(name);
    appendNumber(text_, x);
    return *this;
  }
  JsonText& element(double x) {
    comma();
    appendNumber(text_, x);
    return *this;
  }
  JsonText& point(const std::string& name, const Vector3& x) {
    return open(name, '{').coordinates(x).close('}');
  }
  JsonText& point(const Vector3& x) { return open('{').coordinates(x).close('}'); }
  JsonText& quaternion(const std::string& name, const Quaternion& q) {
    return open(name, '{').coordinates(q.vec()).number("w", q.w()).close('}');
  }
  JsonText& pose(const Transform& X) {
    return open("pose", '{')
        .point("position", X.p)
        .quaternion("orientation", Quaternion(X.R))
        .close('}');
  }
  /// Seconds, as whole ones and nanoseconds.
  JsonText& time(const std::string& name, double seconds) {
    const long long nanoseconds = std::llround(1e9 * seconds);
    return raw(name, "{\"sec\":" + std::to_string(nanoseconds / 1000000000) +
                         ",\"nsec\":" + std::to_string(nanoseconds % 1000000000) + "}");
  }

 private:
  void comma() {
    if (!text_.empty() && text_.back() != '{' && text_.back() != '[') text_ += ',';
  }
  void key(const std::string& name) {
    comma();
    if (name.front() == '"') {
      text_ += name;
    } else {
      text_ += '"';
      text_ += name;
      text_ += '"';
    }
    text_ += ':';
  }
  JsonText& coordinates(const Vector3& x) {
    return number("x", x.x()).number("y", x.y()).number("z", x.z());
  }

  std::string text_;
};

}  // namespace softgauss::io::detail
