// A defect planted for weak_symbols.py: an inline function that is kept as a weak symbol.
namespace gestus::test {

[[gnu::noinline, gnu::used]] inline float Doubled(float x) { return x + x; }

}  // namespace gestus::test
