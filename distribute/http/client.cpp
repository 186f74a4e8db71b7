// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/http/client.h"

#include "distribute/common/files.h"

#include <curl/curl.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <utility>

namespace farm {

using nlohmann::json;

struct Client::Ask {
	std::string method, path;
	const std::string* body = nullptr;
	std::FILE* upload = nullptr;
	long long upload_size = 0;
	std::FILE* download = nullptr;
	std::string place; ///< the download's name
	double patience = 0;
	std::string answer;
	bool json_body = false;
};

namespace {

struct Reply {
	CURL* curl;
	std::string* text;
	std::FILE* file;
	int error; ///< why the file could not be written
};

size_t take(char* data, size_t one, size_t count, void* to) {
	auto& reply = *static_cast<Reply*>(to);
	long status = 0;
	curl_easy_getinfo(reply.curl, CURLINFO_RESPONSE_CODE, &status);
	if (reply.file && status == 200) {
		const size_t written = std::fwrite(data, one, count, reply.file);
		reply.error = written == count ? 0 : errno;
		return written;
	}
	reply.text->append(data, one * count);
	return one * count;
}

size_t give(char* data, size_t one, size_t count, void* from) {
	return std::fread(data, one, count, static_cast<std::FILE*>(from));
}

int watch(void* flag, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
	return static_cast<const std::atomic<bool>*>(flag)->load() ? 1 : 0;
}

/// A cable that was pulled is noticed within half a minute, whether something was to be sent or waited for.
int notice_silence(void*, curl_socket_t socket, curlsocktype) {
	const int on = 1, idle = 10, every = 5, most = 20000; // seconds; the last milliseconds
	::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
	::setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idle, sizeof idle);
	::setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &every, sizeof every);
	::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &most, sizeof most);
	return CURL_SOCKOPT_OK;
}

struct Library {
	Library() { curl_global_init(CURL_GLOBAL_DEFAULT); }
};

using File = std::unique_ptr<std::FILE, decltype(&std::fclose)>;

} // namespace

Client::Client(const Access_to& a) : access(a) {
	static const Library library;
	handle = curl_easy_init();
	while (!access.url.empty() && access.url.back() == '/')
		access.url.pop_back();
	if (access.url.rfind("http://", 0) != 0 && access.url.rfind("https://", 0) != 0)
		throw Error("the server is '" + access.url + "'; it must be http://HOST:PORT or https://HOST:PORT");
}

Client::Client(Client&& other) noexcept
	: handle(std::exchange(other.handle, nullptr)), access(std::move(other.access)), stop(other.stop) {}

Client::~Client() {
	if (handle)
		curl_easy_cleanup(handle);
}

json Client::ask(Ask& request) {
	CURL* curl = handle;
	curl_easy_reset(curl);
	const std::string url = access.url + request.path;
	curl_slist* headers = nullptr;
	if (!access.token.empty())
		headers = curl_slist_append(headers, ("Authorization: Bearer " + access.token).c_str());
	headers = curl_slist_append(
		headers, request.json_body ? "Content-Type: application/json" : "Content-Type: application/octet-stream");
	headers = curl_slist_append(headers, "Expect:"); // a round trip less
	char why[CURL_ERROR_SIZE] = "";
	Reply reply{curl, &request.answer, request.download, 0};
	curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
	curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request.method.c_str());
	curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
	curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, why);
	curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take);
	curl_easy_setopt(curl, CURLOPT_WRITEDATA, &reply);
	curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
	curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, 10L);
	curl_easy_setopt(curl, CURLOPT_SOCKOPTFUNCTION, notice_silence);
	curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
	// What moves no byte for so long has stalled.
	curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, 1L);
	curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, static_cast<long>(60 + request.patience));
	if (!access.authority.empty())
		curl_easy_setopt(curl, CURLOPT_CAINFO, access.authority.c_str());
	if (request.body) {
		curl_easy_setopt(curl, CURLOPT_POSTFIELDS, request.body->data());
		curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body->size()));
	}
	if (request.upload) {
		curl_easy_setopt(curl, CURLOPT_UPLOAD, 1L);
		curl_easy_setopt(curl, CURLOPT_READFUNCTION, give);
		curl_easy_setopt(curl, CURLOPT_READDATA, request.upload);
		curl_easy_setopt(curl, CURLOPT_INFILESIZE_LARGE, static_cast<curl_off_t>(request.upload_size));
	}
	if (stop) {
		curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
		curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, watch);
		curl_easy_setopt(curl, CURLOPT_XFERINFODATA, const_cast<std::atomic<bool>*>(stop));
	}
	const CURLcode code = curl_easy_perform(curl);
	curl_slist_free_all(headers);
	long status = 0;
	curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
	if (code == CURLE_URL_MALFORMAT || code == CURLE_PEER_FAILED_VERIFICATION || code == CURLE_SSL_CACERT_BADFILE)
		throw Distrusted("no answer from " + access.url + ": " + (*why ? why : curl_easy_strerror(code)));
	if (reply.error)
		throw Error("cannot write " + request.place + ": " + std::strerror(reply.error), reply.error);
	if (code != CURLE_OK)
		throw Unreachable("no answer from " + access.url + ": " + (*why ? why : curl_easy_strerror(code)));
	if (request.download && status == 200)
		return nullptr;
	json answer = json::parse(request.answer, nullptr, false);
	if (status < 200 || status >= 300) {
		const bool told = answer.is_object() && answer.contains("error") && answer["error"].is_string();
		throw Refused(static_cast<int>(status),
			told ? answer["error"].get<std::string>() : access.url + " answered " + std::to_string(status));
	}
	if (status == 204)
		return nullptr;
	if (answer.is_discarded())
		throw Unreachable(access.url + " answered with what is no JSON; is that a bhfarm server?");
	return answer;
}

json Client::get(const std::string& path) {
	Ask a;
	a.method = "GET";
	a.path = path;
	return ask(a);
}

json Client::post(const std::string& path, const json& body, double seconds) {
	Ask a;
	// povray's words may be in any encoding.
	const std::string text = body.dump(-1, ' ', false, json::error_handler_t::replace);
	a.method = "POST";
	a.path = path;
	a.body = &text;
	a.json_body = true;
	a.patience = seconds;
	return ask(a);
}

json Client::post(const std::string& path, const json& body) { return post(path, body, 0); }

json Client::remove(const std::string& path) {
	Ask a;
	a.method = "DELETE";
	a.path = path;
	return ask(a);
}

json Client::put(const std::string& path, const std::string& body) {
	Ask a;
	a.method = "PUT";
	a.path = path;
	a.body = &body;
	return ask(a);
}

json Client::put_file(const std::string& path, const std::filesystem::path& file) {
	const File in(std::fopen(file.c_str(), "rb"), std::fclose);
	if (!in)
		throw system_error("cannot read " + file.string());
	Ask a;
	a.method = "PUT";
	a.path = path;
	a.upload = in.get();
	a.upload_size = static_cast<long long>(std::filesystem::file_size(file));
	return ask(a);
}

void Client::download(const std::string& path, const std::filesystem::path& file) {
	const std::string part = file.string() + ".part";
	try {
		File out(std::fopen(part.c_str(), "wb"), std::fclose);
		if (!out)
			throw system_error("cannot write " + file.string());
		Ask a;
		a.method = "GET";
		a.path = path;
		a.download = out.get();
		a.place = file.string();
		ask(a);
		if (std::fclose(out.release()) != 0)
			throw system_error("cannot write " + file.string());
		std::filesystem::rename(part, file);
	} catch (...) {
		std::error_code ignored;
		std::filesystem::remove(part, ignored);
		throw;
	}
}

const std::vector<Option> access_options = {
	{"--server", "URL", "also from BHFARM_SERVER; default http://127.0.0.1:7700", ""},
	{"--token-file", "FILE", "the token in it opens; also from BHFARM_TOKEN_FILE", ""},
	{"--ca", "FILE", "the certificate authority to trust, PEM; also from BHFARM_CA", ""},
};

Access_to access_from(const Arguments& arguments) {
	return access_from(arguments.get("--server"), arguments.get("--token-file"), arguments.get("--ca"));
}

Access_to access_from(const std::string& url, const std::string& token_file, const std::string& authority) {
	Access_to access;
	if (const std::string u = or_environment(url, "BHFARM_SERVER"); !u.empty())
		access.url = u.find("://") == std::string::npos ? "http://" + u : u;
	if (const std::string f = or_environment(token_file, "BHFARM_TOKEN_FILE"); !f.empty()) {
		access.token = read_secret(f);
		access.token = access.token.substr(0, access.token.find_first_of("\r\n \t"));
		if (access.token.empty())
			throw Error("the token file " + f + " is empty");
	}
	access.authority = or_environment(authority, "BHFARM_CA");
	if (!access.authority.empty())
		read_file(access.authority); // or what it says of a server would be no help
	return access;
}

bool on_loopback(const std::string& address) {
	const std::string host = address.substr(0, address.rfind(':'));
	return host == "localhost" || host == "[::1]" || address == "[::1]" || host.rfind("127.", 0) == 0;
}

std::string url_encode(const std::string& text) {
	static const char digits[] = "0123456789ABCDEF";
	std::string out;
	for (const unsigned char c : text) {
		if (std::isalnum(c) || c == '-' || c == '_' || c == '.' || c == '~') {
			out += static_cast<char>(c);
		} else {
			out += '%';
			out += digits[c >> 4];
			out += digits[c & 15];
		}
	}
	return out;
}

} // namespace farm
