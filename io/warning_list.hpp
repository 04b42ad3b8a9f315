// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Warnings for people: those that say the same of several things are one line with a list.

#include <string>
#include <vector>

namespace softgauss::io {

/// Warnings that differ in numbers and in names in quotes alone are of one kind: the first of them
/// stands for all and lists the names of the others, "…; the same of 'b', 'c' and 3 more". Kinds
/// keep the order of their first.
std::vector<std::string> grouped(const std::vector<std::string>& warnings);

}  // namespace softgauss::io
