#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/result.h"

namespace plumb::harness::sweep {

/// Returns the key of a row: scene, engine and all requested settings. Two rows with one key are the same run
/// measured twice.
std::string key_of(const Result& row);

/// Groups the rows by scene, scenes in the order of their first appearance.
std::vector<std::vector<Result>> by_label(std::span<const Result> rows);

/// Returns the engines in the order of their first appearance.
std::vector<std::string> engines_of(std::span<const Result> rows);

/// Keeps the last of the rows with the same key.
std::vector<Result> latest(std::vector<Result> rows);

/// Removes costs so that each scene has costs of only one kind of machine: `machine` if it is not empty,
/// otherwise the kind with the most costs (the first of equals). Rows whose costs are removed are marked with
/// `cost_left_out`. Costs of rows with an unknown machine are kept. Throws `Error` (Name) if no cost is of
/// `machine`.
void keep_costs_of_one_machine(std::vector<Result>& rows, const std::string& machine = "");

/// Returns the kinds of machine that costs of these rows were measured on, those with the most costs first.
std::vector<std::string> machines_of(std::span<const Result> rows);

/// Calls `take` with each row of a file of results, or of `results.jsonl` in a folder, in order. Only one row
/// at a time is in memory. Ignores a truncated last line. Throws `Error` (Io, Syntax) that names file and
/// line.
void for_each_row(const std::string& folder_or_file, const std::function<void(Result)>& take);

/// Reads the latest rows of a file of results, or of `results.jsonl` in a folder. Ignores a truncated last
/// line. Throws `Error` (Io, Syntax) that names file and line.
std::vector<Result> read_all_costs(const std::string& folder_or_file);

/// Throws `Error` (Value) if there are no rows, because an empty table would look like a result.
void require_rows(const std::vector<Result>& rows, const std::string& folder_or_file);

/// Does the same, with the costs of one kind of machine per scene.
std::vector<Result> read_rows(const std::string& folder_or_file, const std::string& machine = "");

/// Returns true if there is a file that `read_rows` would read.
bool holds_rows(const std::string& folder_or_file);

}  // namespace plumb::harness::sweep
