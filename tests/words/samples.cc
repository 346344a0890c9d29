#include "tests/words/samples.h"

namespace gestus::words {
namespace {

// -ojf: tokens with times, marks of the model, a word in two tokens, a comma with a time of its
// own.
const char* const kWhisperCppTokens = R"({
	"systeminfo": "AVX = 1 | AVX2 = 1",
	"model": {"type": "base", "multilingual": false, "vocab": 51864},
	"params": {"model": "models/ggml-base.en.bin", "language": "en", "translate": false},
	"result": {"language": "en"},
	"transcription": [
		{
			"timestamps": {"from": "00:00:00,000", "to": "00:00:02,000"},
			"offsets": {"from": 0, "to": 2000},
			"text": " Hello, gestures.",
			"tokens": [
				{"text": "[_BEG_]", "timestamps": {"from": "00:00:00,000", "to": "00:00:00,000"}, "offsets": {"from": 0, "to": 0}, "id": 50363, "p": 0.96, "t_dtw": -1},
				{"text": " Hello", "timestamps": {"from": "00:00:00,320", "to": "00:00:00,600"}, "offsets": {"from": 320, "to": 600}, "id": 15496, "p": 0.81, "t_dtw": -1},
				{"text": ",", "timestamps": {"from": "00:00:00,600", "to": "00:00:00,900"}, "offsets": {"from": 600, "to": 900}, "id": 11, "p": 0.5, "t_dtw": -1},
				{"text": " gest", "timestamps": {"from": "00:00:00,900", "to": "00:00:01,200"}, "offsets": {"from": 900, "to": 1200}, "id": 12, "p": 0.5, "t_dtw": -1},
				{"text": "ures", "timestamps": {"from": "00:00:01,200", "to": "00:00:01,500"}, "offsets": {"from": 1200, "to": 1500}, "id": 13, "p": 0.5, "t_dtw": -1},
				{"text": ".", "timestamps": {"from": "00:00:01,500", "to": "00:00:02,000"}, "offsets": {"from": 1500, "to": 2000}, "id": 14, "p": 0.5, "t_dtw": -1},
				{"text": "[_TT_100]", "timestamps": {"from": "00:00:02,000", "to": "00:00:02,000"}, "offsets": {"from": 2000, "to": 2000}, "id": 50463, "p": 0.2, "t_dtw": -1}
			]
		}
	]
})";

// -oj: segments only.
const char* const kWhisperCppSegments = R"({"transcription": [
 {"timestamps": {"from": "00:00:00,000", "to": "00:00:01,000"}, "offsets": {"from": 0, "to": 1000}, "text": " and so it"},
 {"timestamps": {"from": "00:00:01,000", "to": "00:00:03,000"}, "offsets": {"from": 1000, "to": 3000}, "text": " [BLANK_AUDIO]"},
 {"timestamps": {"from": "00:00:03,000", "to": "00:00:04,000"}, "offsets": {"from": 3000, "to": 4000}, "text": " goes"}]})";

// -oj -ml 1: a segment for each token, an empty one first; "'t" belongs to the word before it.
const char* const kWhisperCppOneToken = R"({"transcription": [
 {"offsets": {"from": 0, "to": 0}, "text": ""},
 {"offsets": {"from": 0, "to": 300}, "text": " Don"},
 {"offsets": {"from": 300, "to": 400}, "text": "'t"},
 {"offsets": {"from": 400, "to": 700}, "text": " move"},
 {"offsets": {"from": 700, "to": 1000}, "text": "."}]})";

const char* const kOpenAiWords = R"({"text": " Hello twenty-five people.", "segments": [
 {"id": 0, "seek": 0, "start": 0.0, "end": 2.5, "text": " Hello twenty-five people.", "tokens": [50364, 2425],
  "temperature": 0.0, "avg_logprob": -0.2, "compression_ratio": 0.8, "no_speech_prob": 0.01,
  "words": [{"word": " Hello", "start": 0.0, "end": 0.5, "probability": 0.9},
            {"word": " twenty", "start": 0.5, "end": 1.0, "probability": 0.9},
            {"word": "-five", "start": 1.0, "end": 1.5, "probability": 0.9},
            {"word": " people.", "start": 1.5, "end": 2.5, "probability": 0.9}]}], "language": "en"})";

const char* const kOpenAiSegments = R"({"text": " Hi there. Bye.", "segments": [
 {"id": 0, "start": 0.0, "end": 0.8, "text": " Hi there."},
 {"id": 1, "start": 1.0, "end": 2.0, "text": " Bye."}], "language": "en"})";

// A number without times within a segment, one at its beginning, a score that Python could not
// give, a segment that could not be aligned.
const char* const kWhisperX = R"({"segments": [
 {"start": 0.1, "end": 2.0, "text": " go 12 to",
  "words": [{"word": "go", "start": 0.1, "end": 0.4, "score": 0.913, "speaker": "SPEAKER_00"},
            {"word": "12"}, {"word": "to", "start": 0.8, "end": 1.0, "score": NaN}]},
 {"start": 3.0, "end": 4.0, "text": "2014 was",
  "words": [{"word": "2014"}, {"word": "was", "start": 3.0, "end": 4.0, "score": 0.5}]},
 {"start": 5.0, "end": 6.0, "text": "ok ok", "words": []}],
 "word_segments": [{"word": "go", "start": 0.1, "end": 0.4, "score": 0.913}]})";

const char* const kGoogleList =
    R"([{"alternatives": [{"transcript": "deep learning is", "confidence": 0.86, "words": [
 {"start_time": "0.400s", "end_time": "0.800s", "word": "deep"},
 {"start_time": "0.800s", "end_time": "1.300s", "word": "learning"},
 {"start_time": "1.500s", "end_time": "2s", "word": "is"}]}], "language_code": "en-us"}])";

const char* const kGoogleRest = R"({"results": [
 {"alternatives": [{"transcript": "first words", "confidence": 0.9, "words": [
   {"endTime": "0.500s", "word": "first"}, {"startTime": "0.500s", "endTime": "1.200s", "word": "words"}]},
   {"transcript": "worst", "words": [{"startTime": "0s", "endTime": "1s", "word": "worst"}]}],
  "resultEndTime": "1.500s", "languageCode": "en-us"},
 {"alternatives": [{}], "resultEndTime": "2s"},
 {"alternatives": [{"transcript": "no times"}], "resultEndTime": "3.400s"}]})";

const char* const kGoogleProto = R"({"response": {"results": [{"alternatives": [{"words": [
 {"startTime": {}, "endTime": {"seconds": "1", "nanos": 200000000}, "word": "long"},
 {"startTime": {"seconds": 1, "nanos": 200000000}, "endTime": {"seconds": 2}, "word": "time"}]}]}]}})";

// The last result repeats everything with the speakers.
const char* const kGoogleSpeakers = R"({"results": [
 {"alternatives": [{"words": [{"startTime": "0s", "endTime": "1s", "word": "yes"}]}]},
 {"alternatives": [{"words": [{"startTime": "1s", "endTime": "2s", "word": "no"}]}]},
 {"alternatives": [{"words": [{"startTime": "0s", "endTime": "1s", "word": "yes", "speakerTag": 1},
                              {"startTime": "1s", "endTime": "2s", "word": "no", "speakerTag": 2}]}]}]})";

// Offsets count characters, not bytes, of the transcript, which alone has the punctuation.
const char* const kGentle = R"({"transcript": "Caf\u00e9, yes. Uh no!", "words": [
 {"alignedWord": "cafe", "case": "success", "end": 0.9, "endOffset": 4, "phones": [{"duration": 0.1, "phone": "k_B"}], "start": 0.4, "startOffset": 0, "word": "Caf\u00e9"},
 {"case": "not-found-in-audio", "endOffset": 9, "startOffset": 6, "word": "yes"},
 {"alignedWord": "um", "case": "not-found-in-transcript", "end": 1.6, "phones": [], "start": 1.5},
 {"alignedWord": "uh", "case": "success", "end": 2.0, "endOffset": 13, "start": 1.8, "startOffset": 11, "word": "Uh"},
 {"alignedWord": "<unk>", "case": "not-found-in-transcript", "end": 2.2, "phones": [], "start": 2.1},
 {"alignedWord": "no", "case": "success", "end": 2.5, "endOffset": 16, "start": 2.2, "startOffset": 14, "word": "no"}]})";

const char* const kMfaJson = R"({"start": 0, "end": 2.0, "tiers": {
 "words": {"type": "interval", "entries": [[0.0, 0.3, ""], [0.3, 0.9, "this"], [0.9, 1.4, "is"], [1.4, 2.0, "<eps>"]]},
 "phones": {"type": "interval", "entries": [[0.3, 0.9, "DH"]]}}})";

const char* const kVosk = R"({"result": [{"conf": 1.0, "end": 0.9, "start": 0.5, "word": "one"},
 {"conf": 1.0, "end": 1.5, "start": 1.0, "word": "two"}], "text": "one two"})";

// As AssemblyAI gives them: whole milliseconds.
const char* const kMillisecondList =
    R"({"words": [{"text": "Hello", "start": 250, "end": 650, "confidence": 0.97},
 {"text": "you.", "start": 730, "end": 1022, "confidence": 0.99}]})";

// As youtube-transcript-api gives them; they overlap.
const char* const kPhrases = R"([{"text": "so much", "start": 1.0, "duration": 3.0},
 {"text": "more", "start": 2.0, "duration": 1.5}])";

// A tool has taken the blanks off the tokens.
const char* const kBareTokens =
    R"({"transcription": [{"offsets": {"from": 0, "to": 900}, "text": "What are you",
 "timestamps": {}, "tokens": [{"text": "What", "offsets": {"from": 0, "to": 300}},
 {"text": "are", "offsets": {"from": 300, "to": 500}}, {"text": "you", "offsets": {"from": 500, "to": 900}},
 {"text": "<|endoftext|>", "offsets": {}}]}]})";

// No blanks at all: ideographs and kana are words, what follows them belongs to them.
const char* const kChinese =
    R"({"transcription": [{"offsets": {"from": 0, "to": 900}, "text": "\u5B66\u4E60\u3002",
 "tokens": [{"text": "\u5B66", "offsets": {"from": 0, "to": 300}}, {"text": "\u4E60", "offsets": {"from": 300, "to": 800}},
 {"text": "\u3002", "offsets": {"from": 800, "to": 900}}]}]})";

const char* const kCtm =
    ";; a comment\n"
    "talk A 0.400 0.400 deep 0.99\n"
    "talk A 0.800 0.500 learning 1.00\n"
    "talk A 1.300 0.200 <eps>\n"
    "talk A 1.500 0.200 is\n";

// Recording and channel are numbers.
const char* const kCtmNumbers = "1001 1 0.40 0.40 deep\n1001 1 0.80 0.50 20\n";

const char* const kTextGridLong = R"(File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0 
xmax = 2.5 
tiers? <exists> 
size = 3 
item []: 
    item [1]:
        class = "IntervalTier" 
        name = "anna - words" 
        xmin = 0 
        xmax = 2.5 
        intervals: size = 4 
        intervals [1]:
            xmin = 0 
            xmax = 0.4 
            text = "" 
        intervals [2]:
            xmin = 0.4 
            xmax = 0.8 
            text = "she" 
        intervals [3]:
            xmin = 0.8 
            xmax = 1.2 
            text = "said ""no""" 
        intervals [4]:
            xmin = 1.2 
            xmax = 2.5 
            text = "sil" 
    item [2]:
        class = "IntervalTier" 
        name = "anna - phones" 
        xmin = 0 
        xmax = 2.5 
        intervals: size = 1 
        intervals [1]:
            xmin = 0 
            xmax = 2.5 
            text = "SH" 
    item [3]:
        class = "TextTier" 
        name = "marks" 
        xmin = 0 
        xmax = 2.5 
        points: size = 1 
        points [1]:
            number = 1.0 
            mark = "click" 
)";

const char* const kTextGridShort =
    "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n"
    "0\n2\n<exists>\n1\n\"IntervalTier\"\n\"words\"\n0\n2\n3\n"
    "0\n0.5\n\"this\" ! the first\n0.5\n1.1\n\"is\"\n1.1\n2\n\"\"\n";

const char* const kWebVtt =
    "WEBVTT - with a title\nKind: captions\n\n"
    "STYLE\n::cue { color: red }\n\nNOTE not said\nand not this\n\n"
    "intro\n00:01.000 --> 00:02.000 align:start position:0%\n<v Anna>Salt &amp; "
    "<i>pepper</i></v>\n\n"
    "1:00:03.000 --> 1:00:04.000\n\u202Bשלום\u202C\n";

const char* const kYouTube =
    "WEBVTT\nKind: captions\nLanguage: en\n\n"
    "00:00:00.240 --> 00:00:02.629 align:start position:0%\n \n"
    "deep<00:00:00.480><c> learning</c><00:00:00.960><c> is</c>\n\n"
    "00:00:02.629 --> 00:00:02.639 align:start position:0%\ndeep learning is\n \n\n"
    "00:00:02.639 --> 00:00:04.000 align:start position:0%\ndeep learning is\n"
    "an<00:00:03.120><c> algorithm</c>\n\n"
    "00:00:04.000 --> 00:00:04.010 align:start position:0%\nan algorithm\n \n\n"
    "00:00:04.010 --> 00:00:05.000 align:start position:0%\nan algorithm\n[Music]\n";

const char* const kSrt =
    "1\r\n00:00:01,000 --> 00:00:02,000\r\n{\\an8}<b>Hello</b>\r\n\r\n"
    "2\r\n00:00:02,500 --> 00:00:04,500\r\n- Who's there?\r\n- 42\r\n\r\n"
    "3\r\n00:00:05,000 --> 00:00:06,000\r\n2024\r\n";

const char* const kPrinted =
    "[00:00:00.000 --> 00:00:01.000]   And so\n"
    "[00:00:01.000 --> 00:00:02.000]   42\n";

// pandas writes it so.
const char* const kCsv =
    "id,Word,Start,End\n0,deep,0.4,0.8\n1,\"learn,ing\",0.8,1.3\n2,\"a "
    "\"\"b\"\"\",,\n3,is,1.5,2.0\n";
const char* const kCsvSemicolon = "end;start;text\n0,8;0,4;deep\n1,3;0,8;learning\n";
const char* const kCsvPlain = "deep, 0.4, 0.8\nlearning, 0.8, 1.3\n";
const char* const kCsvGentle = "Deep,deep,0.4,0.8\nmind,,,\nis,is,1.5,2.0\n";
const char* const kMfaCsv =
    "Begin,End,Label,Type,Speaker\n0.4,0.8,this,words,anna\n0.8,1.2,is,words,anna\n"
    "0.4,0.6,DH,phones,anna\n0.6,0.8,IH,phones,anna\n";
// openai-whisper's .tsv: milliseconds, no quoting.
const char* const kWhisperTsv = "start\tend\ttext\n0\t1000\t\"Hi, you\n1000\t2000\tthere\"\n";
const char* const kWhisperCppCsv =
    "start,end,text\n0,1000,\" Hi \"\"you\"\"\"\n1000,2000,\" there\"\n";

const char* const kLines = "# start end word\n0.40 0.80 deep\n0.80 1.30 learning\n\n1.50 1.70 is\n";
const char* const kLinesReversed = "deep 0,4 0,8 0.93\nlearning 0,8 1,3 0.91\n";
const char* const kAudacity =
    "0.400000\t0.800000\tdeep\n\\\t100.0\t200.0\n0.800000\t1.200000\tNew York\n1.2\t1.5\t\n";

std::string Utf16(const std::string& ascii, bool big_endian) {
  std::string bytes = big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : ascii) {
    if (big_endian) bytes += '\0';
    bytes += c;
    if (!big_endian) bytes += '\0';
  }
  return bytes;
}

std::vector<Sample> MakeSamples() {
  const std::string grid_words = "this 0.00-0.50, is 0.50-1.10";
  return {
      {"whisper.cpp tokens", kWhisperCppTokens, "whisper.cpp JSON",
       "Hello, 0.32-0.60, gestures. 0.90-1.50"},
      {"whisper.cpp segments", kWhisperCppSegments, "whisper.cpp JSON",
       "and 0.00-0.43*, so 0.43-0.71*, it 0.71-1.00*, goes 3.00-4.00"},
      {"whisper.cpp -ml 1", kWhisperCppOneToken, "whisper.cpp JSON",
       "Don't 0.00-0.40, move. 0.40-0.70"},
      {"openai-whisper words", kOpenAiWords, "openai-whisper JSON",
       "Hello 0.00-0.50, twenty-five 0.50-1.50, people. 1.50-2.50"},
      {"openai-whisper segments", kOpenAiSegments, "openai-whisper JSON",
       "Hi 0.00-0.20*, there. 0.20-0.80*, Bye. 1.00-2.00"},
      {"WhisperX", kWhisperX, "WhisperX JSON",
       "go 0.10-0.40, 12 0.40-0.80*, to 0.80-1.00, 2014 2.09-3.00*, was 3.00-4.00, "
       "ok 5.00-5.50*, ok 5.50-6.00*"},
      {"Google list", kGoogleList, "Google speech JSON",
       "deep 0.40-0.80, learning 0.80-1.30, is 1.50-2.00"},
      {"Google REST", kGoogleRest, "Google speech JSON",
       "first 0.00-0.50, words 0.50-1.20, no 2.00-2.40*, times 2.40-3.40*"},
      {"Google protocol buffers", kGoogleProto, "Google speech JSON",
       "long 0.00-1.20, time 1.20-2.00"},
      {"Google speakers", kGoogleSpeakers, "Google speech JSON", "yes 0.00-1.00, no 1.00-2.00"},
      {"Gentle", kGentle, "Gentle JSON",
       "Caf\u00e9, 0.40-0.90, yes. 0.90-1.50*, um 1.50-1.60, Uh 1.80-2.00, no! 2.20-2.50"},
      {"MFA JSON", kMfaJson, "MFA JSON", "this 0.30-0.90, is 0.90-1.40"},
      {"Vosk", kVosk, "JSON word list", "one 0.50-0.90, two 1.00-1.50"},
      {"milliseconds", kMillisecondList, "JSON word list", "Hello 0.25-0.65, you. 0.73-1.02"},
      {"phrases", kPhrases, "JSON list of phrases",
       "so 1.00-1.33*, much 1.33-2.00*, more 2.00-3.50"},
      {"whisper.cpp, bare tokens", kBareTokens, "whisper.cpp JSON",
       "What 0.00-0.30, are 0.30-0.50, you 0.50-0.90"},
      {"whisper.cpp, Chinese", kChinese, "whisper.cpp JSON",
       "\u5B66 0.00-0.30, \u4E60\u3002 0.30-0.80"},
      {"CTM", kCtm, "CTM", "deep 0.40-0.80, learning 0.80-1.30, is 1.50-1.70"},
      {"CTM of numbers", kCtmNumbers, "CTM", "deep 0.40-0.80, 20 0.80-1.30"},
      {"long TextGrid", kTextGridLong, "Praat TextGrid",
       "she 0.40-0.80, said 0.80-1.00*, \"no\" 1.00-1.20*"},
      {"short TextGrid", kTextGridShort, "Praat TextGrid", grid_words},
      {"UTF-16 TextGrid", Utf16(kTextGridShort, true), "Praat TextGrid", grid_words},
      {"UTF-16 TextGrid, little endian", Utf16(kTextGridShort, false), "Praat TextGrid",
       grid_words},
      {"WebVTT", kWebVtt, "WebVTT",
       "Salt 1.00-1.36*, & 1.36-1.45*, pepper 1.45-2.00*, "
       "\u202B\u05E9\u05DC\u05D5\u05DD\u202C 3603.00-3604.00"},
      {"YouTube", kYouTube, "WebVTT",
       "deep 0.24-0.48, learning 0.48-0.96, is 0.96-2.63, an 2.64-3.12, algorithm 3.12-4.00"},
      {"SRT", kSrt, "SRT",
       "Hello 1.00-2.00, Who's 2.50-3.27*, there? 3.27-4.19*, 42 4.19-4.50*, 2024 5.00-6.00"},
      {"printed", kPrinted, "Whisper's printed lines",
       "And 0.00-0.60*, so 0.60-1.00*, 42 1.00-2.00"},
      {"CSV", kCsv, "CSV",
       "deep 0.40-0.80, learn,ing 0.80-1.30, a 1.30-1.35*, \"b\" 1.35-1.50*, is 1.50-2.00"},
      {"CSV with semicolons", kCsvSemicolon, "CSV", "deep 0.40-0.80, learning 0.80-1.30"},
      {"CSV without header", kCsvPlain, "CSV", "deep 0.40-0.80, learning 0.80-1.30"},
      {"Gentle's CSV", kCsvGentle, "CSV", "Deep 0.40-0.80, mind 0.80-1.50*, is 1.50-2.00"},
      {"MFA's CSV", kMfaCsv, "CSV", "this 0.40-0.80, is 0.80-1.20"},
      {"Whisper's TSV", kWhisperTsv, "table with tabs",
       "\"Hi, 0.00-0.57*, you 0.57-1.00*, there\" 1.00-2.00"},
      {"whisper.cpp's CSV", kWhisperCppCsv, "CSV",
       "Hi 0.00-0.29*, \"you\" 0.29-1.00*, there 1.00-2.00"},
      {"lines", kLines, "lines of start, end and word",
       "deep 0.40-0.80, learning 0.80-1.30, is 1.50-1.70"},
      {"lines, word first", kLinesReversed, "lines of start, end and word",
       "deep 0.40-0.80, learning 0.80-1.30"},
      {"Audacity", kAudacity, "lines of start, end and word",
       "deep 0.40-0.80, New 0.80-0.97*, York 0.97-1.20*"},
  };
}

}  // namespace

const std::vector<Sample>& Samples() {
  static const std::vector<Sample> samples = MakeSamples();
  return samples;
}

}  // namespace gestus::words
