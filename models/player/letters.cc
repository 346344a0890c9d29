// Drawn by hand on a grid of 5 columns (0 to 4) and 7 rows (0 to 6, downwards): a stroke is a run
// of points, each a digit of its column and one of its row; blanks lie between strokes.
#include "models/player/letters.h"

#include <array>
#include <string_view>

namespace gestus::player {
namespace {

struct Letter {
  char name;
  std::string_view strokes;
};

// clang-format off
constexpr std::array<Letter, 40> kLetters = {{
    {'A', "062046 1434"},                {'B', "06003041423303 3344453606"},
    {'C', "4130100105163645"},           {'D', "06002042442606"},
    {'E', "40000646 0333"},              {'F', "400006 0333"},
    {'G', "41301001051636454323"},       {'H', "0006 4046 0343"},
    {'I', "2026"},                       {'J', "4045361605"},
    {'K', "0006 4003 0346"},             {'L', "000646"},
    {'M', "0600234046"},                 {'N', "06004640"},
    {'O', "103041453616050110"},         {'P', "06003041423303"},
    {'Q', "103041453616050110 2446"},    {'R', "06003041423303 2346"},
    {'S', "413010010213334445361605"},   {'T', "0040 2026"},
    {'U', "000516364540"},               {'V', "002640"},
    {'W', "0016233640"},                 {'X', "0046 4006"},
    {'Y', "0023 4023 2326"},             {'Z', "00400646"},
    {'0', "103041453616050110"},         {'1', "112026"},
    {'2', "01103041420646"},             {'3', "01103041423323 334445361605"},
    {'4', "36300444"},                   {'5', "400002324345361605"},
    {'6', "4130100105163645443303"},     {'7', "004016"},
    {'8', "13020110304142331304051636454433"}, {'9', "0516364541301001021343"},
    {':', "2222 2525"},                  {'.', "2626"},
    {'-', "1333"},                       {'/', "0640"},
}};
// clang-format on

}  // namespace

std::vector<std::vector<Vec2>> StrokesOf(char letter) {
  const char capital =
      letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  std::vector<std::vector<Vec2>> strokes;
  for (const Letter& known : kLetters) {
    if (known.name != capital) continue;
    strokes.emplace_back();
    for (std::size_t i = 0; i < known.strokes.size();) {
      if (known.strokes[i] == ' ') {
        strokes.emplace_back();
        ++i;
        continue;
      }
      strokes.back().push_back(
          {(known.strokes[i] - '0') / 4.0, (known.strokes[i + 1] - '0') / 6.0});
      i += 2;
    }
  }
  return strokes;
}

}  // namespace gestus::player
