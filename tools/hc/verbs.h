// SPDX-License-Identifier: Apache-2.0
#pragma once
// The verbs of hc: each function adds a subcommand with its callback.

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>

#include <hc/base/format.h>
#include <hc/base/text.h>

namespace tool {

/// For options that are whole numbers: CLI11 would read -1 as the largest number, and print ranges
/// of 300 digits.
inline CLI::Validator whole_number() {
  return {[](const std::string& text) {
            return text.find_first_not_of("0123456789") == std::string::npos
                       ? std::string()
                       : "\"" + text + "\" is not a whole number from 0 on";
          },
          "", "whole_number"};
}

inline constexpr double kLongest = 1e9;  ///< duration on the command line [s]

/// A number in a range, which excludes nan and inf.
inline CLI::Validator number_in(double least, double most) {
  return {[least, most](const std::string& text) {
            double number = 0;
            return hc::read_number(text, number) && number >= least && number <= most
                       ? std::string()
                       : hc::format("\"{}\" is not a number from {:g} to {:g}", text, least, most);
          },
          "", "number"};
}

/// Options that several verbs have.
inline void add_limit(CLI::App& verb, std::uint64_t& limit) {
  verb.add_option("--limit", limit, "maximum message size [byte]")->check(whole_number());
}
inline void add_count(CLI::App& verb, std::uint64_t& count) {
  verb.add_option("--count", count, "end after this many messages; 0: never")
      ->check(whole_number());
}
inline CLI::Option* add_of(CLI::App& verb, std::string& of) {
  return verb.add_option("--of", of, "name of the running graph, if there are several (hc ps)");
}
inline void add_source(CLI::App& verb, std::string& uri, std::string& of) {
  verb.add_option("source", uri, "URI, file, or MODULE.PORT of a running graph")
      ->capture_default_str();
  add_of(verb, of);
}

/// Prints the words that may stand where the last one is, a line each, for shells.
/// @param words  of the command line, after `hc`; the last one may be empty.
void complete(const CLI::App& app, const std::vector<std::string>& words);

void add_agent(CLI::App& app);
void add_cat(CLI::App& app);
void add_check(CLI::App& app);
void add_completion(CLI::App& app);
void add_describe(CLI::App& app);
void add_doctor(CLI::App& app);
void add_estop(CLI::App& app);
void add_frames(CLI::App& app);
void add_graph(CLI::App& app);
void add_info(CLI::App& app);
void add_key(CLI::App& app);
void add_manual(CLI::App& app);
void add_new(CLI::App& app);
void add_page(CLI::App& app);
void add_play(CLI::App& app);
void add_ports(CLI::App& app);
void add_ps(CLI::App& app);
void add_record(CLI::App& app);
void add_replay(CLI::App& app);
void add_run(CLI::App& app);
void add_send(CLI::App& app);
void add_top(CLI::App& app);
void add_trace(CLI::App& app);

}  // namespace tool
