# SPDX-License-Identifier: AGPL-3.0-or-later
"""A bad network: between workers and a server, by TCP. Its moods: calm; slow (pieces come late); cut (connections break midway); deaf (requests go through, answers do
not, so that what was acknowledged is sent again); dead (nobody is let through, and what is open stands still, then breaks)."""
import asyncio
import random
import re
import threading


class Proxy:
    def __init__(self, seed, to):
        self.random, self.to, self.mood, self.port = random.Random(seed), to, "calm", 0
        self.cuts = 0
        self.hello = {} # what a worker said of itself
        ready = threading.Event()
        self.loop = asyncio.new_event_loop()

        def run():
            asyncio.set_event_loop(self.loop)
            server = self.loop.run_until_complete(asyncio.start_server(self.accept, "127.0.0.1", 0))
            self.port = server.sockets[0].getsockname()[1]
            ready.set()
            self.loop.run_forever()
        threading.Thread(target=run, daemon=True).start()
        ready.wait()

    async def accept(self, reader, writer):
        try:
            if self.mood == "dead":
                raise ConnectionError
            to_reader, to_writer = await asyncio.open_connection(self.to.host, self.to.port)
        except (OSError, ValueError):
            writer.close()
            return
        both = (writer, to_writer)
        asyncio.ensure_future(self.carry(reader, to_writer, both, False))
        asyncio.ensure_future(self.carry(to_reader, writer, both, True))

    async def carry(self, reader, writer, both, answers):
        try:
            while piece := await reader.read(4096):
                dice = self.random.random()
                for key in ("povray", "probe"):
                    if not answers and (found := re.search(b'"%s":"([^"]+)"' % key.encode(), piece)):
                        self.hello[key] = found.group(1).decode()
                if self.mood == "slow":
                    await asyncio.sleep(0.2 * dice)
                elif self.mood == "cut" and dice < 0.3:
                    self.cuts += 1
                    writer.write(piece[:int(len(piece) * self.random.random())])
                    await writer.drain()
                    break
                elif self.mood == "deaf" and answers and dice < 0.6:
                    self.cuts += 1
                    break
                elif self.mood == "dead":
                    self.cuts += 1
                    await asyncio.sleep(1.5 * dice)
                    break
                writer.write(piece)
                await writer.drain()
        except OSError:
            pass
        for w in both:
            w.close()
