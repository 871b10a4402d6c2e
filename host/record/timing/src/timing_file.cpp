#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/link/codec.h>
#include <tether/os/text_file.h>
#include <tether/timing/timing.h>

// A timing file is text. Each line is a key and its values, separated by tabs: first what was
// timed, the parts of each UAV's build, what is in doubt, then each run with a line for each call,
// then the number of calls.
namespace tether::timing {
namespace {

constexpr std::string_view kMagic = "tether-timing";
constexpr int kSchema = 2;  // 1 has no builds and no condition

/// The keys of the texts at the beginning, in their order.
constexpr std::pair<std::string_view, std::string Timing::*> kTexts[] = {
    {"scenario", &Timing::scenario},   {"program", &Timing::program},
    {"build_id", &Timing::build_id},   {"board", &Timing::board},
    {"clock", &Timing::clock},         {"recorded", &Timing::recorded_at},
    {"condition", &Timing::condition},  // not in schema 1
};

using Words = std::vector<std::string_view>;

class Parser {
 public:
  Parser(std::string text, const std::filesystem::path& file)
      : text_(std::move(text)), file_(file) {}

  Timing parse() {
    const int schema = read_schema();
    Timing timing;
    for (const auto& [key, member] : kTexts)
      if (schema > 1 || member != &Timing::condition) timing.*member = text_of(key);
    Words words = next();
    for (; words[0] == "counted"; words = next()) {
      require_words(words, 3);
      const auto value = number<double>(words[2]);
      if (!(value >= 0.0)) fail(fmt::format("counted work is \"{}\", not a number ≥ 0", words[2]));
      timing.counted_ns[std::string(words[1])] = value;
    }
    for (; words[0] == "build"; words = next()) {
      require_words(words, 4);
      timing.builds[std::string(words[1])].push_back(
          {std::string(words[2]), std::string(words[3])});
    }
    for (; words[0] == "doubt"; words = next()) add(timing, read_doubt(words));
    std::size_t calls = 0;
    for (; words[0] != "end"; words = next()) {
      if (words[0] == "run") {
        require_words(words, 3);
        timing.runs.push_back({std::string(words[1]), number<std::uint64_t>(words[2]), {}});
      } else if (words[0] == "call" && !timing.runs.empty()) {
        timing.runs.back().calls.push_back(read_call(words));
        ++calls;
      } else {
        fail(fmt::format("\"{}\" was found where \"run\", \"call\" or \"end\" is expected",
                         words[0]));
      }
    }
    require_words(words, 2);
    if (number<std::size_t>(words[1]) != calls)
      fail(fmt::format("the file has {} calls, but should have {}. Calls were lost; write it again",
                       calls, words[1]));
    if (calls == 0) fail("the file has no calls. Write it from the record of a run");
    if (at_ != text_.size()) fail("there is text after the end");
    return timing;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::kBadFile, {file_.string(), line_}, what + ".").about(file_.string());
  }

  int read_schema() {
    if (text_.empty()) fail("the file is empty. Write it with: tether timing RECORD... --out FILE");
    const Words words = next();
    if (words[0] != kMagic) fail("this is not a timing file, which `tether timing --out` writes");
    require_words(words, 2);
    const int schema = number<int>(words[1]);
    if (schema < 1 || schema > kSchema)
      fail(fmt::format(
          "the file has schema {}, and this version of Tether reads schemas up to {}. Write "
          "it again with this version",
          schema, kSchema));
    return schema;
  }

  /// The words of the next line.
  Words next() {
    const std::size_t end = text_.find('\n', at_);
    ++line_;
    if (end == std::string::npos)
      fail("the file is truncated here. Write it again with: tether timing RECORD... --out FILE");
    Words words;
    std::string_view line(text_.data() + at_, end - at_);
    at_ = end + 1;
    for (std::size_t tab = 0; tab != std::string_view::npos; line.remove_prefix(tab + 1)) {
      tab = line.find('\t');
      words.push_back(line.substr(0, tab));
      if (tab == std::string_view::npos) break;
    }
    return words;
  }

  void require_words(const Words& words, std::size_t count) const {
    if (words.size() != count)
      fail(
          fmt::format("\"{}\" has {} values instead of {}", words[0], words.size() - 1, count - 1));
  }

  std::string text_of(std::string_view key) {
    const Words words = next();
    if (words[0] != key)
      fail(fmt::format("\"{}\" was found where \"{}\" is expected", words[0], key));
    require_words(words, 2);
    return std::string(words[1]);
  }

  template <class Number>
  Number number(std::string_view word) const {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      fail(fmt::format("\"{}\" is not a number in range", word));
    return value;
  }

  Doubt read_doubt(const Words& words) const {
    require_words(words, 4);
    Doubt doubt{.subject = std::string(words[2]), .amount = number<double>(words[3])};
    if (!(doubt.amount >= 0.0 && std::isfinite(doubt.amount)))
      fail(fmt::format("a doubt has the amount \"{}\", not a number ≥ 0", words[3]));
    for (std::size_t i = 0; i < kDoubts; ++i) {
      doubt.kind = static_cast<Doubt::Kind>(i);
      if (name(doubt.kind) == words[1]) return doubt;
    }
    fail(fmt::format("\"{}\" is no kind of doubt", words[1]));
  }

  Call read_call(const Words& words) const {
    if (words.size() < 2 || words.size() % 2 != 0)
      fail("a call needs a name, then pairs of a stage and its time");
    Call call{std::string(words[1]), {}};
    for (std::size_t i = 2; i < words.size(); i += 2) {
      const auto time_ns = number<std::int64_t>(words[i + 1]);
      if (time_ns < 0 || time_ns >= link::kMaxTimestampNs)
        fail(fmt::format("stage \"{}\" takes {} ns, which is negative or too long", words[i],
                         time_ns));
      if (words[i].empty()) fail("a stage has no name");
      for (const link::StageTime& other : call.stages)
        if (other.stage == words[i])
          fail(fmt::format("stage \"{}\" is twice before one call", words[i]));
      call.stages.push_back({std::string(words[i]), Duration(time_ns)});
    }
    return call;
  }

  std::string text_;
  std::filesystem::path file_;
  std::size_t at_ = 0;
  int line_ = 0;
};

void append_line(std::string& out, std::initializer_list<std::string> words) {
  bool is_first = true;
  for (const std::string& word : words) {
    if (!is_first) out += '\t';
    out += printable(word);  // no tab, no end of line
    is_first = false;
  }
  out += '\n';
}

}  // namespace

bool is_timing_file(const std::filesystem::path& file) {
  return os::begin_of(file, kMagic.size()) == kMagic;
}

Timing read_timing(const std::filesystem::path& file) {
  return Parser(os::read_file(file), file).parse();
}

void write_timing(const std::filesystem::path& file, const Timing& timing) {
  std::string out;
  append_line(out, {std::string(kMagic), std::to_string(kSchema)});
  for (const auto& [key, member] : kTexts) append_line(out, {std::string(key), timing.*member});
  for (const auto& [stage, work_ns] : timing.counted_ns)
    append_line(out, {"counted", stage, fmt::format("{}", work_ns)});
  for (const auto& [uav, build] : timing.builds)
    for (const link::BuildPart& part : build)
      append_line(out, {"build", uav, part.name, part.value});
  for (const Doubt& doubt : timing.doubts)
    append_line(out, {"doubt", std::string(name(doubt.kind)), doubt.subject,
                      fmt::format("{}", doubt.amount)});
  std::size_t calls = 0;
  for (const Run& run : timing.runs) {
    append_line(out, {"run", run.uav, std::to_string(run.seed)});
    for (const Call& call : run.calls) {
      out += "call\t" + printable(call.call);
      for (const link::StageTime& time : call.stages)
        out += fmt::format("\t{}\t{}", printable(time.stage), time.computing.count());
      out += '\n';
      ++calls;
    }
  }
  append_line(out, {"end", std::to_string(calls)});
  os::write_file_atomically(file, out);
}

}  // namespace tether::timing
