// SPDX-License-Identifier: AGPL-3.0-or-later
// Small pictures of frames, fetched a few at a time and only for what is on the screen.

const at_once = 3;
/** Milliseconds between two pictures of a frame that fills in. */
const patience = 1000, sulk = 10000;

export class Previews {
	wanted = new Map(); // tile -> {url, version, whole}
	busy = 0;

	/** Shows a frame in a tile as it stands at `version`; `whole` when nothing more will come. */
	show(tile, url, version, whole) {
		if (tile.version === version || (tile.failed === version && Date.now() - tile.fetched < sulk))
			return;
		this.wanted.set(tile, { url: `${url}&at=${encodeURIComponent(version)}`, version, whole });
		this.next();
	}
	forget(tile) { this.wanted.delete(tile); }

	next() {
		for (const [tile, wish] of this.wanted) {
			if (this.busy >= at_once)
				return;
			const wait = wish.whole ? 0 : (tile.fetched ?? 0) + patience - Date.now();
			if (wait > 0) {
				clearTimeout(this.timer);
				this.timer = setTimeout(() => this.next(), wait);
				continue;
			}
			this.wanted.delete(tile);
			this.fetch(tile, wish);
		}
	}

	fetch(tile, { url, version }) {
		++this.busy;
		tile.fetched = Date.now();
		tile.version = version;
		const picture = new Image(), frame = tile.frame;
		picture.className = "picture";
		picture.alt = "";
		const done = good => {
			--this.busy;
			if (tile.frame !== frame || tile.version !== version)
				; // the tile is further by now
			else if (good)
				tile.querySelector(".picture").replaceWith(picture);
			else {
				tile.version = null;
				tile.failed = version; // with the next change, or after a while
			}
			this.next();
		};
		picture.onload = () => done(true);
		picture.onerror = () => done(false);
		picture.src = url;
	}
}
