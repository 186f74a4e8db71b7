// SPDX-License-Identifier: AGPL-3.0-or-later
// The server's news as they come (docs/PROTOCOL.md, /v1/events), through restarts and broken networks.

/** The server says something every 15 seconds; so long without a word, and the connection is made anew. */
const silence = 40000;
/** A tab that nobody sees gives its connection back after so long (a browser has six a server), and looks once a minute. */
const unseen = 30000, glance = 60000;

export class Stream {
	/** `take` gets each piece; `state` gets "live" or "lost". */
	constructor(take, state) {
		this.take = take;
		this.state = state;
		document.addEventListener("visibilitychange", () => this.look());
		this.open();
	}

	open() {
		this.close();
		const source = this.source = new EventSource("/v1/events");
		source.onmessage = message => {
			this.rearm();
			this.state("live");
			this.take(JSON.parse(message.data));
		};
		source.onerror = () => {
			this.state("lost");
			if (source.readyState === EventSource.CLOSED)
				this.again();
		};
		this.rearm();
	}

	close() {
		clearTimeout(this.timer);
		this.source?.close();
		this.source = null;
	}

	rearm() {
		clearTimeout(this.timer);
		this.timer = setTimeout(() => {
			this.state("lost");
			this.open();
		}, silence);
	}

	// The browser tries no more: the server answered, but not with a stream.
	async again() {
		try {
			const answer = await fetch("/v1/jobs", { method: "HEAD" });
			if (answer.status === 401)
				return location.reload(); // to the sign-in
		} catch { // not there yet
		}
		clearTimeout(this.timer);
		this.timer = setTimeout(() => this.open(), 2000);
	}

	look() {
		clearTimeout(this.rest);
		clearInterval(this.glances);
		if (!document.hidden) {
			if (!this.source)
				this.open();
			return;
		}
		this.rest = setTimeout(() => {
			this.close();
			this.glances = setInterval(async () => {
				try {
					const answer = await fetch("/v1/jobs");
					if (answer.ok)
						this.take({ event: "jobs", ...await answer.json() });
				} catch { // the next one will do
				}
			}, glance);
		}, unseen);
	}
}
