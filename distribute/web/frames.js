// SPDX-License-Identifier: AGPL-3.0-or-later
// The frames of the chosen job as they fill in. Only those on the screen exist, however many there are.
import { byId, el } from "./text.js";
import { drawColumn } from "./strips.js";

const gap = 8, column = 9, border = 2;

export function blank(tag) {
	return el(tag, { class: "tile" }, el("canvas", { class: "strips" }), el("span", { class: "picture" }), el("span", { class: "number" }));
}

/** Shows a frame in a tile: its strips, and what has come of its picture. */
export function fill(tile, index, model, previews, size) {
	const job = model.chosen, frame = model.frame(index), done = model.settled[index];
	const which = `${job.id} ${job.created} ${index}`;
	if (tile.frame !== which) {
		tile.frame = which;
		tile.version = tile.fetched = null;
		tile.querySelector(".picture").replaceWith(el("span", { class: "picture" }));
	}
	drawColumn(tile.querySelector(".strips"), frame, job);
	const number = tile.querySelector(".number"), text = job.animation ? String(model.number(index)) : "";
	if (number.textContent !== text)
		number.textContent = text;
	number.hidden = !text;
	tile.classList.toggle("ready", done === frame.length);
	tile.setAttribute("aria-label", `${job.animation ? `Frame ${model.number(index)}` : "The picture"}: ${done} of ${frame.length} strips done`);
	if (done > 0) {
		// Which strips it has; one that is called into question is missing for a while.
		const has = frame.reduce((h, letter, i) => (letter === "s" ? Math.imul(h, 31) + i | 0 : h), 7) >>> 0;
		previews.show(tile, `/v1/jobs/${job.id}/preview/${model.number(index)}?size=${size}`, `${Math.round(job.created)}.${has}`, done === frame.length);
	} else if (tile.version) {
		tile.version = null;
		tile.querySelector(".picture").replaceWith(el("span", { class: "picture" }));
	}
}

export class Frames {
	tiles = new Map(); // by index
	following = true;

	constructor(model, previews, open) {
		Object.assign(this, { model, previews, open, box: byId("frames"), field: byId("frame-field") });
		this.box.addEventListener("scroll", () => this.draw());
		// Who scrolls wants to look elsewhere.
		for (const kind of ["wheel", "touchmove", "keydown", "pointerdown"])
			this.box.addEventListener(kind, e => {
				if (kind === "keydown" ? /^(Arrow|Page|Home|End| )/.test(e.key) : kind !== "pointerdown" || e.target === this.box)
					this.follow(false);
			}, { passive: true });
		new ResizeObserver(() => this.draw()).observe(this.box);
		byId("follow").onclick = () => {
			this.follow(!this.following);
			this.draw();
		};
	}

	follow(on) {
		this.following = on;
		byId("follow").setAttribute("aria-pressed", String(on));
	}

	/** Brings a frame into sight. */
	go(index) {
		this.follow(false);
		this.box.scrollTop = Math.floor(index / this.columns) * this.row;
		this.draw();
	}

	/** Sizes by the room there is and by how many frames share it. */
	measure() {
		const job = this.model.chosen, room = this.box.clientWidth;
		const tall = 0.55 * innerHeight;
		const wish = job.frames === 1 ? room : job.frames <= 6 ? 320 : room < 500 ? 130 : 176;
		this.columns = Math.max(1, Math.min(job.frames, Math.floor((room + gap) / (wish + gap))));
		let width = job.frames === 1 ? Math.min(room, 960) : Math.floor((room + gap) / Math.max(this.columns, Math.floor((room + gap) / (wish + gap)))) - gap;
		let height = (width - column - border) * job.height / job.width + border;
		const most = job.frames === 1 ? tall : Math.min(tall, 1.6 * width);
		if (height > most) { // an upright picture
			height = most;
			width = (height - border) * job.width / job.height + column + border;
		}
		Object.assign(this, { width: Math.floor(width), height: Math.max(24, Math.floor(height)) });
		this.row = this.height + gap;
		this.rows = Math.ceil(job.frames / this.columns);
		this.field.style.height = `${this.rows * this.row - gap}px`;
		this.size = Math.min(1024, 64 * Math.ceil(Math.max(this.width, this.height) * devicePixelRatio / 64));
	}

	/** The first frame that is not finished, in the middle of the box. */
	chase() {
		let first = this.model.settled.findIndex(n => n < this.model.chosen.strips_per_frame);
		if (first < 0)
			first = this.model.chosen.frames - 1;
		const top = Math.floor(first / this.columns) * this.row - this.row;
		const there = Math.max(0, Math.min(top, this.box.scrollHeight - this.box.clientHeight));
		if (Math.abs(this.box.scrollTop - there) > 1)
			this.box.scrollTop = there;
	}

	draw() {
		const { model, box } = this;
		if (model.chosen && model.chosen.id !== this.job) {
			this.job = model.chosen.id;
			this.follow(true);
			box.scrollTop = 0;
		}
		if (!model.chosen || !model.strips.length || box.clientWidth === 0)
			return;
		this.measure();
		const fits = this.field.offsetHeight <= box.clientHeight + 1;
		byId("follow").hidden = fits;
		if (this.following && !fits && model.chosen.stage === "running")
			this.chase();
		const from = Math.max(0, Math.floor(box.scrollTop / this.row) - 1) * this.columns;
		const to = Math.min(model.chosen.frames, (Math.ceil((box.scrollTop + box.clientHeight) / this.row) + 1) * this.columns);
		for (const [index, tile] of this.tiles)
			if (index < from || index >= to) {
				this.previews.forget(tile);
				tile.remove();
				this.tiles.delete(index);
			}
		for (let index = from; index < to; ++index) {
			let tile = this.tiles.get(index);
			if (!tile) {
				tile = blank("button");
				tile.onclick = () => this.open(index);
				this.tiles.set(index, tile);
				this.field.append(tile);
			}
			Object.assign(tile.style, {
				left: `${index % this.columns * (this.width + gap)}px`, top: `${Math.floor(index / this.columns) * this.row}px`, width: `${this.width}px`, height: `${this.height}px`,
			});
			fill(tile, index, model, this.previews, this.size);
		}
	}
}
