// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/graph_command.h>

#include <algorithm>
#include <array>
#include <iterator>

#include <hc/base/suggestion.h>
#include <hc/base/text.h>
#include <hc/mtp/rows.h>

namespace hc {
namespace {

using Verb = GraphCommand::Verb;

constexpr std::string_view kReply = "reply ", kOk = "ok";

struct Form {
  std::string_view name;
  Verb verb;
  std::size_t words;  // after it; the minimum
  bool takes_more;
  std::string_view text;
};

constexpr std::array<Form, 11> kForms = {{
    {"set", Verb::Set, 1, true, "set MODULE.PARAMETER=VALUE"},
    {"add", Verb::Add, 2, true, "add MODULE[@HOST] PROGRAM [PARAMETER=VALUE ...]"},
    {"remove", Verb::Remove, 1, false, "remove MODULE"},
    {"restart", Verb::Restart, 1, false, "restart MODULE"},
    {"link", Verb::Link, 2, true, "link FROM TO [KEY=VALUE ...]"},
    {"unlink", Verb::Unlink, 2, false, "unlink FROM TO"},
    {"stop", Verb::Stop, 0, false, "stop"},
    {"describe", Verb::Describe, 1, false, "describe MODULE"},
    {"observe", Verb::Observe, 1, false, "observe MODULE.PORT"},
    {"feed", Verb::Feed, 1, false, "feed MODULE.PORT"},
    {"notices", Verb::Notices, 0, false, "notices"},
}};

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty())
    if (const auto word = take_until(text, ' '); !word.empty()) words.emplace_back(word);
  return words;
}

}  // namespace

Result<Assignment> parse_assignment(std::string_view text) {
  const auto dot = text.find('.'), equals = text.find('=');
  if (dot == std::string_view::npos || equals == std::string_view::npos || dot > equals)
    return Error{Code::Invalid, "\"" + std::string(text) + "\" is not MODULE.PARAMETER=VALUE"};
  return Assignment{std::string(text.substr(0, dot)),
                    std::string(text.substr(dot + 1, equals - dot - 1)),
                    std::string(text.substr(equals + 1))};
}

Result<GraphCommand> parse_graph_command(std::string_view line) {
  auto words = split(line);
  if (words.empty()) return Error{Code::Invalid, "there is no command"};
  const auto form = std::ranges::find(kForms, words[0], &Form::name);
  if (form == kForms.end()) {
    std::vector<std::string> names;
    std::ranges::transform(kForms, std::back_inserter(names),
                           [](const Form& each) { return std::string(each.name); });
    return Error{Code::Invalid, "no command \"" + words[0] + "\"" + suggestion(words[0], names)};
  }
  GraphCommand command{form->verb, {words.begin() + 1, words.end()}};
  const std::size_t count = command.words.size();
  if (count < form->words || (count > form->words && !form->takes_more))
    return Error{Code::Invalid, "usage: " + std::string(form->text)};
  if (form->verb == Verb::Set) {  // the value may contain spaces
    auto assignment =
        HC_TRY(parse_assignment(line.substr(line.find(command.words[0], form->name.size()))));
    command.words = {std::move(assignment.module), std::move(assignment.parameter),
                     std::move(assignment.value)};
  }
  return command;
}

Message make_request(const GraphRequest& request) {
  std::vector<std::string> rows;
  if (!request.reply.empty()) rows.push_back(std::string(kReply) + request.reply);
  rows.insert(rows.end(), request.lines.begin(), request.lines.end());
  return make_rows(rows);
}

GraphRequest read_request(const Message& message) {
  GraphRequest request{{}, rows_of(message)};
  if (!request.lines.empty() && request.lines.front().starts_with(kReply)) {
    request.reply = request.lines.front().substr(kReply.size());
    request.lines.erase(request.lines.begin());
  }
  return request;
}

Message make_answer(const GraphAnswer& answer) {
  auto rows = answer.rows;
  if (answer.is_ok) rows.emplace(rows.begin(), kOk);
  return make_rows(rows);
}

GraphAnswer read_answer(const Message& message) {
  GraphAnswer answer{false, rows_of(message)};
  answer.is_ok = !answer.rows.empty() && answer.rows.front() == kOk;
  if (answer.is_ok)
    answer.rows.erase(answer.rows.begin());
  else if (answer.rows.empty())
    answer.rows.emplace_back("an empty answer");
  return answer;
}

}  // namespace hc
