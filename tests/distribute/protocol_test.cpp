// SPDX-License-Identifier: AGPL-3.0-or-later
// What is taken from others: messages, addresses, command lines, POV-Ray's words.
#include "distribute/common/arguments.h"
#include "distribute/common/error.h"
#include "distribute/http/router.h"
#include "distribute/protocol/fields.h"
#include "distribute/protocol/messages.h"
#include "distribute/render/povray.h"
#include "distribute/scene/ini.h"
#include "tests/distribute/good_job.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

using namespace farm;

namespace {

/// What is wrong with a message, in one line; empty if nothing is.
template <class T> std::string fault(const json& j) {
	try {
		j.get<T>();
		return "";
	} catch (const Error& e) {
		EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
		return e.what();
	}
}

TEST(Protocol, AJobComesBackAsItWas) {
	const json sent = good_job();
	const JobSpec back = parse_object(sent.dump()).get<JobSpec>();
	EXPECT_EQ(json(back), sent);
	EXPECT_EQ(back.frames(), 24);
	EXPECT_EQ(back.strips(), 24 * 6);
	EXPECT_EQ(back.picture(7), "film07.png");
}

TEST(Protocol, EachFieldIsChecked) {
	const std::pair<const char*, json> bad[] = {{"name", "a/b"}, {"name", ".."}, {"name", ""}, {"name", 5}, {"name", nullptr},
		{"bundle", "xyz"}, {"bundle", std::string(64, 'G')}, {"options", "A=1"}, {"options", json::array({5})},
		{"options", json::array({"no equals"})}, {"options", json::array({"A=1\nShell=rm"})}, {"width", 0}, {"width", -1},
		{"width", 1e9}, {"width", 3.5}, {"width", "640"}, {"height", 70000}, {"first", -1}, {"last", 0}, {"step", 0},
		{"digits", 11}, {"format", "tga"}, {"format", nullptr}, {"bits", 12}, {"bits", 32}, {"strip_rows", 0}, {"animation", 1},
		{"priority", 101}, {"film_rate", -1}, {"film_rate", "x"}, {"last", 18446744073709551615u}};
	for (const auto& [key, value] : bad) {
		json j = good_job();
		j[key] = value;
		EXPECT_NE(fault<JobSpec>(j), "") << key << " = " << value;
	}
	for (const int height : {16384, 16385}) { // 2^30 pixels, and a row more
		json j = good_job();
		j["width"] = j["strip_rows"] = 65536;
		j["height"] = height;
		const std::string why = fault<JobSpec>(j);
		EXPECT_EQ(why.empty(), height == 16384) << why;
		EXPECT_EQ(why.find("65536x16385, 1073807360 pixels") != std::string::npos, height == 16385) << why;
	}
	for (const char* line : {"A=1", "Declare=A=-1.5", "Library_Path=\"a b\"", "Input_File_Name='x\"y.pov'", "A=x[1]"}) {
		json j = good_job();
		j["options"] = {line};
		EXPECT_EQ(fault<JobSpec>(j), "") << line;
	}
	// What POV-Ray's INI reader would take for more than one setting, or let it swallow those that follow.
	for (const char* line : {"[a=b]", "+O/etc/x=1", "-A=1", ";=1", "#=1", "=1", "A=", "A B=1", "A=\"open", "A='open",
			 "A=\"x\" B=2", "A=x y", "A=x,y", "A=1;", "\"A\"=1", "A=\x01", "A=x\r", "/x=1", "a.ini A=1"}) {
		json j = good_job();
		j["options"] = {line};
		EXPECT_NE(fault<JobSpec>(j), "") << line;
	}
	const json all = good_job();
	for (const auto& [key, value] : all.items()) {
		json j = good_job();
		j.erase(key);
		const bool may = key == "whole_because" || key == "priority" || key == "film_rate" || key == "client_key";
		EXPECT_EQ(fault<JobSpec>(j).empty(), may) << key;
	}
	json more = good_job();
	more["from_the_future"] = 1;
	EXPECT_EQ(fault<JobSpec>(more), "");
}

TEST(Protocol, ABundleStaysInside) {
	const auto named = [](const std::string& name) {
		return json{{"folder", ""}, {"files", {{{"name", name}, {"sha256", std::string(64, '0')}, {"bytes", 1}}}}};
	};
	EXPECT_EQ(fault<Bundle>(named("a/b c/ü.inc")), "");
	for (const char* name : {"", "/etc/passwd", "../x", "a/../../x", "a//b", "./a", "a/", "a\nb", "a/.."})
		EXPECT_NE(fault<Bundle>(named(name)), "") << name;
	json twice = named("a");
	twice["files"].push_back(twice["files"][0]);
	EXPECT_NE(fault<Bundle>(twice), "");
	json both = named("a");
	both["files"].push_back(named("a/b")["files"][0]);
	EXPECT_NE(fault<Bundle>(both), "") << "a is a file and a folder";
	both["files"].push_back(named("a-b")["files"][0]);
	EXPECT_NE(fault<Bundle>(both), "") << "with another between them in the alphabet";
	json folder = named("a/b");
	folder["folder"] = "a/b";
	EXPECT_NE(fault<Bundle>(folder), "") << "povray would run in a file";
	json bomb = named("a");
	bomb["files"][0]["bytes"] = 10LL << 30;
	EXPECT_NE(fault<Bundle>(bomb), "");
	json out = named("a");
	out["folder"] = "../..";
	EXPECT_NE(fault<Bundle>(out), "");
}

TEST(Protocol, WhatIsNoJsonIsRefused) {
	std::string deep(100000, '[');
	for (const std::string& text : {std::string(""), std::string("{"), std::string("[]"), std::string("5"),
			 std::string("{\"a\":\"\xff\"}"), "{\"a\":" + deep, std::string("{\"a\":1}x"), std::string("\0", 1)})
		EXPECT_THROW(parse_object(text), Error) << text.substr(0, 20);
	std::mt19937 random(1);
	const std::string sent = json(good_job()).dump();
	for (int i = 0; i < 20000; ++i) { // whatever comes, it is taken or refused
		std::string text = sent;
		for (int k = 0; k < 3; ++k)
			text[random() % text.size()] = static_cast<char>(random());
		try {
			parse_object(text).get<JobSpec>().strips();
		} catch (const Error&) {
		}
	}
}

TEST(Router, PathsQueriesAndMethods) {
	Router router;
	router.add("GET", "/v1/jobs/*/frames/*", {});
	Request r;
	r.method = "GET";
	router.find(r, "/v1/jobs/5/frames/a%20b.png?x=1&y=a%2Bb+c");
	EXPECT_EQ(r.parts, (std::vector<std::string>{"5", "a b.png"}));
	EXPECT_EQ(r.asked("y"), "a+b c");
	const auto status = [&](const char* method, const char* target) {
		Request q;
		q.method = method;
		try {
			router.find(q, target);
			return 200;
		} catch (const HttpError& e) {
			return e.status;
		}
	};
	EXPECT_EQ(status("GET", "/v1/jobs//frames/x"), 404);
	EXPECT_EQ(status("GET", "/v1/jobs/5/frames/x/y"), 404);
	EXPECT_EQ(status("POST", "/v1/jobs/5/frames/x"), 405);
	EXPECT_EQ(status("GET", "/v1/jobs/5/frames/%"), 400);
	EXPECT_EQ(status("GET", "/v1/jobs/5/frames/%00"), 400);
	EXPECT_EQ(status("GET", ""), 404);
}

TEST(Arguments, ValuesSwitchesAndTheRest) {
	const std::vector<Option> options = {{"--n", "N", "", "7"}, {"--go", "", "", ""}};
	const Arguments a({"x", "--n=5", "+W1", "--go", "--n", "6"}, options);
	EXPECT_EQ(a.rest, (std::vector<std::string>{"x", "+W1"}));
	EXPECT_EQ(a.number("--n", 0, 10), 6);
	EXPECT_EQ(a.all("--n"), (std::vector<std::string>{"5", "6"}));
	EXPECT_TRUE(a.has("--go"));
	EXPECT_EQ(Arguments({}, options).get("--n"), "7");
	for (const std::vector<std::string>& bad : {std::vector<std::string>{"--m"}, {"--n"}, {"--go=1"}})
		EXPECT_THROW(Arguments(bad, options), Error);
	for (const char* text : {"", "5x", "0x5", "-1", "11", "99999999999999999999"})
		EXPECT_THROW(Arguments({"--n", text}, options).number("--n", 0, 10), Error) << text;
}

TEST(Ini, AsPovrayReadsIt) {
	const auto folder = std::filesystem::temp_directory_path() / ("ini-test-" + std::to_string(::getpid()));
	std::filesystem::create_directories(folder / "sub");
	std::ofstream(folder / "a.ini")
		<< "; a comment\nWidth = 320 ; more\n+H240 -A +FN16 Declare=\"x y\"\nInput_File_Name=my scene.pov\n"
		   "Library_Path=\"one, two\", three\n'sub/b.ini'\n[Big]\nWidth=640\n[Small]\r\nWidth=32\r\n";
	std::ofstream(folder / "sub/b.ini") << "Quality=5\nPost_Frame_Command=rm -rf %o ; x\n";
	using All = std::vector<Setting>;
	const All common = {{"Width", "320"}, {"Height", "240"}, {"Antialias", "Off"}, {"Output_To_File", "On"},
		{"Output_File_Type", "N"}, {"Bits_Per_Color", "16"}, {"Declare", "x y"}, {"Input_File_Name", "my scene.pov"},
		{"Library_Path", "one, two"}, {"Library_Path", "three"}, {"Quality", "5"}, {"Post_Frame_Command", "rm -rf %o ; x"}};
	EXPECT_EQ(read_ini((folder / "a.ini").string()), common);
	All big = common;
	big.emplace_back("Width", "640");
	EXPECT_EQ(read_ini((folder / "a.ini").string() + "[big]"), big);
	EXPECT_THROW(read_ini((folder / "a.ini").string() + "[None]"), Error);
	EXPECT_THROW(read_ini((folder / "c.ini").string()), Error);
	for (const Setting& s : common)
		if (s.first != "Post_Frame_Command" && s.first != "Library_Path")
			EXPECT_EQ(read_word(ini_line(s)), All{s});
	EXPECT_EQ(read_word("Declare=S=a b"), (All{{"Declare", "S=a b"}}));
	EXPECT_EQ(read_word("+KFF10"), (All{{"Final_Frame", "10"}}));
	EXPECT_EQ(read_word("+KF0.5"), (All{{"Final_Clock", "0.5"}}));
	EXPECT_EQ(read_word("-D"), (All{{"Display", "Off"}}));
	EXPECT_EQ(read_word("+A0.05"), (All{{"Antialias", "On"}, {"Antialias_Threshold", "0.05"}}));
	EXPECT_THROW(read_word("+Zebra"), Error);
	std::filesystem::remove_all(folder);
}

TEST(Povray, ErrorsAsOneLine) {
	EXPECT_EQ(
		error_line("==== [Parsing...] ====\nFile 'a.pov' line 2: Possible Parse Error: Cannot find file 'nosuch.inc', even\n"
				   " after trying.\nFile 'a.pov' line 2: Parse Error: Cannot open include\n file nosuch.inc.\nFatal error in "
				   "parser: Cannot parse input.\nRender failed\n",
			1),
		"File 'a.pov' line 2: Parse Error: Cannot open include file nosuch.inc.");
	const std::string folder = "/a/folder/" + std::string(60, 'x'); // broken where the line is full
	EXPECT_EQ(error_line("File '" + folder +
							 "/sub\n/b.inc' line 2: Parse Error: Cannot open user file x\n (read).\nFatal error in parser\n",
				  1, folder),
		"File 'sub/b.inc' line 2: Parse Error: Cannot open user file x (read).");
	EXPECT_EQ(
		error_line("File 'a.pov' line 1: Possible Parse Error: Cannot find file 'no.png', even\n after trying to append file "
				   "type extension.\nFile 'a.pov' line 1: Possible Parse Error: Cannot find image file.\nFatal error in "
				   "parser: Cannot open file.\nRender failed\n",
			1),
		"File 'a.pov' line 1: Possible Parse Error: Cannot find file 'no.png', even after trying to append file type extension.");
	EXPECT_EQ(error_line("", 137), "povray was ended by signal 9 (out of memory, perhaps)");
	EXPECT_NE(error_line("", 0), "");
}

TEST(Povray, RowsAsItCountsThem) {
	Task task;
	task.spec = good_job();
	const auto rows = [&](int row, int count) {
		task.row = row;
		task.rows = count;
		const std::string ini = strip_ini(task, "x");
		std::string said;
		for (const char* key : {"Start_Row=", "End_Row="})
			if (const size_t at = ini.find(key); at != std::string::npos)
				said += ini.substr(at, ini.find('\n', at) - at) + " ";
		return said;
	};
	EXPECT_EQ(rows(0, 360), "");
	EXPECT_EQ(rows(0, 64), "End_Row=64 ");
	EXPECT_EQ(rows(64, 64), "Start_Row=65 End_Row=128 ");
	EXPECT_EQ(rows(320, 40), "Start_Row=321 ");
	EXPECT_EQ(rows(0, 1), "End_Row=1.5 ") << "1 would be all of them";
}

// A worker's or a scene's words reach a terminal: escapes are 27, and in UTF-8 also 0x80 to 0x9f, of two bytes.
TEST(Terminal, NothingSteersIt) {
	EXPECT_EQ(for_terminal("a\x1b[31m\x07\n\x7f"), "a [31m   ");
	EXPECT_EQ(for_terminal("a\xc2\x9b"
						   "31m\xc2\x80\xc2\x9f"),
		"a  31m    ");
	EXPECT_EQ(for_terminal("\xc3\xbc \xc2\xa0\xc3\x9f \xe2\x9b\x84 \xc2"), "\xc3\xbc \xc2\xa0\xc3\x9f \xe2\x9b\x84 \xc2")
		<< "letters stay";
	EXPECT_EQ(for_terminal("a\nb\tc\rd", true), "a\nb\tc d");
}

} // namespace
