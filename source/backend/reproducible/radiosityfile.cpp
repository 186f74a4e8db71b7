// SPDX-License-Identifier: AGPL-3.0-or-later
// The radiosity cache as a file that brings back the very same cache: every number to its last bit, every list in its order.
// Stock's file keeps normals to 8 bits and colours to 4 decimals. Stock's reader finds none of its samples in ours: its lines
// start with a capital letter, and ours have none.
#include <cstdio>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/scene/view.h"
#include "backend/lighting/radiosity.h"
#include "backend/support/octree.h"
#include "backend/reproducible/reproducible.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

// AddBlock would find the node anew, from a distance that has been rounded since.
struct Opened_Pool : RadiosityCache::BlockPool
{
	static OT_BLOCK *New(BlockPool& pool) { return (pool.*&Opened_Pool::NewBlock)(); }
};

static const char First_Line[] = "reproducible radiosity 1\n";

struct File_Closer
{
	FILE *file;
	~File_Closer() { if(file != NULL) fclose(file); }
};

// A node's list has its latest sample first; written earliest first, the list comes out the same when it is read.
static long Save_Node(const OT_NODE *node, FILE *file)
{
	if(node == NULL)
		return 0;
	std::vector<const OT_BLOCK *> blocks;
	for(const OT_BLOCK *b = node->Values; b != NULL; b = b->next)
		blocks.push_back(b);
	for(size_t i = blocks.size(); i-- > 0;)
	{
		const OT_BLOCK& b = *blocks[i];
		fprintf(file, "%d %d %d %d %d %d %d", node->Id.x, node->Id.y, node->Id.z, node->Id.Size, int(b.TileId), int(b.Pass), int(b.Bounce_Depth));
		fprintf(file, " %a %a %a %a %a %a", b.Point[X], b.Point[Y], b.Point[Z], b.S_Normal[X], b.S_Normal[Y], b.S_Normal[Z]);
		fprintf(file, " %a %a %a", b.To_Nearest_Surface[X], b.To_Nearest_Surface[Y], b.To_Nearest_Surface[Z]);
		fprintf(file, " %a %a %a", b.Illuminance[pRED], b.Illuminance[pGREEN], b.Illuminance[pBLUE]);
		fprintf(file, " %a %a %a\n", b.Harmonic_Mean_Distance, b.Nearest_Distance, b.Quality);
	}
	long count = blocks.size();
	for(int kid = 0; kid < 8; kid++)
		count += Save_Node(node->Kids[kid], file);
	return count;
}

bool Reproducible::Save(const RadiosityCache& cache, const std::string& name)
{
	File_Closer f = { fopen(name.c_str(), "w") };
	if(f.file == NULL)
		return false;
	fputs(First_Line, f.file);
	const long count = Save_Node(cache.octree.root, f.file);
	fprintf(f.file, "end %ld\n", count);
	const bool whole = !ferror(f.file) && (fclose(f.file) == 0);
	f.file = NULL;
	return whole;
}

bool Reproducible::Load(RadiosityCache& cache, const std::string& name)
{
	File_Closer f = { fopen(name.c_str(), "r") };
	char line[1000];
	if((f.file == NULL) || (fgets(line, sizeof(line), f.file) == NULL) || (std::string(line) != First_Line))
		return false;

	RadiosityCache::BlockPool *pool = cache.AcquireBlockPool();
	long count = 0, said = -1;
	while(fgets(line, sizeof(line), f.file) != NULL)
	{
		OT_ID id;
		int tile, pass, depth, read;
		Vector3d point, normal, nearest;
		float red, green, blue, mean, distance, quality;
		if(sscanf(line, "end %ld", &said) == 1)
			break;
		read = sscanf(line, "%d %d %d %d %d %d %d %lf %lf %lf %lf %lf %lf %lf %lf %lf %f %f %f %f %f %f", &id.x, &id.y, &id.z, &id.Size, &tile, &pass, &depth,
		              &point[X], &point[Y], &point[Z], &normal[X], &normal[Y], &normal[Z], &nearest[X], &nearest[Y], &nearest[Z],
		              &red, &green, &blue, &mean, &distance, &quality);
		if(read != 22)
			break;
		OT_BLOCK *block = Opened_Pool::New(*pool);
		block->Point = point;
		block->S_Normal = normal;
		block->To_Nearest_Surface = nearest;
		block->Illuminance = RGBColour(red, green, blue);
		block->Harmonic_Mean_Distance = mean;
		block->Nearest_Distance = distance;
		block->Quality = quality;
		block->TileId = OT_TILE(tile);
		block->Pass = OT_PASS(pass);
		block->Bounce_Depth = OT_DEPTH(depth);
		cache.InsertBlock(cache.GetNode(NULL, id), block);
		count++;
	}
	cache.ReleaseBlockPool(pool);
	if(said != count)
		throw POV_EXCEPTION(kFileDataErr, "Radiosity_File_Name=" + name + ": the file is not whole; it is written by Reproducible=on Radiosity_To_File=on");
	return true;
}

}
