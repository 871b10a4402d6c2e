#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/base/time.h>
#include <tether/base_testing/damage.h>
#include <tether/wire/field_checker.h>
#include <tether/wire/reader.h>
#include <tether/wire/writer.h>

namespace tether::wire {
namespace {

enum class Color : std::uint8_t { kRed, kBlue };

struct Point {
  double x = 0.0;
  int label = 0;
  friend bool operator==(const Point&, const Point&) = default;
};
constexpr void fields(auto& io, Is<Point> auto& m) {
  io("x", m.x);
  io("label", m.label, Rule{[](int label) { return label < 100; }, "is too large"});
}

}  // namespace
template <>
inline constexpr bool kIsStruct<Point> = true;
namespace {

struct Nothing {
  friend bool operator==(const Nothing&, const Nothing&) = default;
};
void fields(auto&, Is<Nothing> auto&) {}

struct Leaf {
  std::string text;
  friend bool operator==(const Leaf&, const Leaf&) = default;
};
void fields(auto& io, Is<Leaf> auto& m) {
  io("text", m.text, AtMost{8});
}

/// Has each kind of field.
struct Tree {
  bool flag = false;
  Color color = Color::kRed;
  double factor = 1.0;
  SimTime at{};
  Duration wait{0};
  std::optional<std::uint32_t> index{};
  Point point{};
  std::string name{};
  std::vector<std::uint8_t> pixels{};
  std::vector<float> depths{};
  std::vector<Point> points{};
  std::vector<std::string> texts{};
  std::vector<Leaf> leaves{};
  std::variant<Nothing, Leaf> one{};
  std::optional<std::variant<Nothing, Leaf>> maybe_one{};
  std::optional<Leaf> leaf{};
  friend bool operator==(const Tree&, const Tree&) = default;
};
void fields(auto& io, Is<Tree> auto& m) {
  io.here("Tree: ");
  io("flag", m.flag);
  io("color", m.color, known_up_to(Color::kBlue));
  io("factor", m.factor, Default{1.0}, kPositive);
  io("at", m.at);
  io("wait", m.wait);
  io("index", m.index);
  io("point", m.point);
  io("name", m.name, AtMost{8});
  io("pixels", m.pixels, Apart{});
  io("depths", m.depths, OmitEmpty{});
  io("points", m.points, OmitEmpty{}, AtMost{4, "are too many"});
  io("texts", m.texts, OmitEmpty{}, AtMost{4}, EachAtMost{8});
  io("leaves", m.leaves, OmitEmpty{}, AtMost{4});
  io("one", m.one);
  io("maybe_one", m.maybe_one);
  io("leaf", m.leaf);
  io.require([&m] { return m.wait <= m.at.time_since_epoch(); }, "wait", "ends after at");
}

std::string text_of(KeyedRandom& random) {
  return std::string(random.bits() % 9, static_cast<char>('a' + random.bits() % 26));
}

Tree tree_of(std::uint64_t seed) {
  KeyedRandom random({3, 7, seed});
  const auto coin = [&random] { return random.bits() % 2 == 0; };
  const auto point = [&] { return Point{random.uniform(), static_cast<int>(random.bits() % 100)}; };
  Tree tree;
  tree.flag = coin();
  tree.color = coin() ? Color::kRed : Color::kBlue;
  tree.factor = coin() ? 1.0 : 0.1 + random.uniform();
  tree.at = from_ns<SimTime>(1 + random.bits());
  tree.wait = Duration(coin() ? 0 : 1);
  if (coin()) tree.index = random.bits() % 5;
  tree.point = point();
  tree.name = text_of(random);
  tree.pixels.assign(random.bits() % 9, 7);
  tree.depths.assign(random.bits() % 3, 0.5F);
  for (auto n = random.bits() % 5; n > 0; --n) tree.points.push_back(point());
  for (auto n = random.bits() % 5; n > 0; --n) tree.texts.push_back(text_of(random));
  for (auto n = random.bits() % 5; n > 0; --n) tree.leaves.push_back({text_of(random)});
  if (coin()) tree.one = Leaf{text_of(random)};
  if (coin()) tree.maybe_one = Leaf{text_of(random)};
  if (coin()) tree.leaf = Leaf{text_of(random)};
  return tree;
}

using Bytes = std::vector<std::uint8_t>;

Bytes frame_of(const Tree& tree) {
  FrameWriter writer;
  writer.write(tree, "TREE");
  const auto frame = writer.whole();
  return {frame.begin(), frame.end()};
}
Result<Tree> read(const Bytes& frame) {
  return read_frame<Tree>(frame, "TREE", 32, "a tree");
}
std::string complaint(const Tree& tree) {
  FieldChecker checker;
  checker("tree", tree);
  return checker.status().ok() ? "" : checker.status().failure().message;
}

TEST(Frame, HasEachFieldWholeAndInPieces) {
  FrameWriter writer;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Tree tree = tree_of(seed);
    ASSERT_EQ(complaint(tree), "");
    const Bytes frame = frame_of(tree);
    const auto got = read(frame);
    ASSERT_TRUE(got.ok()) << seed << ": " << got.failure().message;
    ASSERT_EQ(*got, tree) << seed;
    const FramePieces pieces = writer.write(tree, "TREE");
    Bytes joined;
    for (const auto piece : {pieces.head, pieces.image, pieces.tail})
      joined.insert(joined.end(), piece.begin(), piece.end());
    ASSERT_EQ(joined, frame) << seed;
    ASSERT_EQ(pieces.image.data(), tree.pixels.empty() ? nullptr : tree.pixels.data());
  }
}

TEST(Frame, IsTheSameWhateverTheReaderHadBefore) {
  Tree tree = tree_of(3);
  Leaf kept{"kept"};
  tree.leaf = kept;
  ASSERT_TRUE(read(frame_of(tree)).ok());
  tree.leaf.reset();
  EXPECT_EQ(read(frame_of(tree)).value().leaf, std::nullopt);
}

// In any order of damage: never outside of the frame (the sanitizers see that), never a crash.
TEST(Frame, ThatIsDamagedIsRefusedOrRead) {
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    KeyedRandom random({5, 7, seed});
    Bytes frame = frame_of(tree_of(seed % 200));
    damage(frame, random);
    const auto got = read(frame);
    if (!got) {
      ASSERT_EQ(got.failure().kind, Failure::Kind::kProtocol);
    }
  }
}

TEST(Frame, WithoutARequiredFieldIsCorrupt) {
  FrameWriter writer;
  writer.write(Nothing{}, "TREE");
  const auto frame = writer.whole();
  const auto got = read_frame<Tree>(frame, "TREE", 32, "a tree");
  ASSERT_FALSE(got.ok());
  EXPECT_THAT(got.failure().message, testing::HasSubstr("not a tree, or corrupt"));
}

TEST(Frame, WithTooManyItemsIsRefusedBeforeTheyAreRead) {
  Tree tree;
  tree.at = from_ns<SimTime>(1);
  tree.points.resize(5);
  const auto got = read(frame_of(tree));
  ASSERT_FALSE(got.ok());
  EXPECT_THAT(got.failure().message, testing::HasSubstr("points are too many"));
}

TEST(Frame, OfAnotherIdentifierIsRefused) {
  EXPECT_FALSE(read_frame<Tree>(frame_of(tree_of(1)), "LEAF", 32, "a leaf").ok());
}

TEST(FieldChecker, NamesTheFieldThatIsWrong) {
  using Spoil = void (*)(Tree&);
  const std::vector<std::pair<const char*, Spoil>> cases = {
      {"Tree: color is unknown", [](Tree& t) { t.color = static_cast<Color>(2); }},
      {"Tree: factor is not a positive number", [](Tree& t) { t.factor = 0.0; }},
      {"Tree: factor is not a finite number", [](Tree& t) { t.factor = 1.0 / 0.0; }},
      {"Tree: at is negative", [](Tree& t) { t.at = from_ns<SimTime>(-1); }},
      {"Tree: point is not a finite number", [](Tree& t) { t.point.x = 0.0 / 0.0; }},
      {"Tree: point is too large", [](Tree& t) { t.point.label = 100; }},
      {"Tree: points is too large",
       [](Tree& t) {
         t.points.assign(1, {0.0, 100});
       }},
      {"Tree: points are too many", [](Tree& t) { t.points.resize(5); }},
      {"Tree: name is longer than 8 bytes", [](Tree& t) { t.name = "123456789"; }},
      {"Tree: name contains a NUL byte", [](Tree& t) { t.name.assign(1, '\0'); }},
      {"Tree: texts is longer than 8 bytes", [](Tree& t) { t.texts = {"123456789"}; }},
      {"Tree: texts has too many entries", [](Tree& t) { t.texts.resize(5); }},
      {"Tree: text is longer than 8 bytes", [](Tree& t) { t.leaf = Leaf{"123456789"}; }},
      {"Tree: wait ends after at", [](Tree& t) { t.wait = Duration(std::int64_t{1} << 40); }}};
  for (const auto& [what, spoil] : cases) {
    Tree tree = tree_of(1);
    spoil(tree);
    EXPECT_THAT(complaint(tree), testing::HasSubstr(what));
  }
}

}  // namespace
}  // namespace tether::wire
